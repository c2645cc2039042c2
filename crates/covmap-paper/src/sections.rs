//! The parts of the report: what each shows, how it is made, and the claims about it.

/// A part of the report: a figure or a table of the paper, and the claims about it.
#[derive(Debug)]
pub(crate) struct Section {
    /// The mark on the page.
    pub(crate) id: &'static str,
    pub(crate) heading: &'static str,
    /// The files of the figures, without their endings; the report shows those that exist.
    pub(crate) figures: &'static [&'static str],
    /// The files with the numbers, without their endings; the report links those that exist.
    pub(crate) numbers: &'static [&'static str],
    /// The command that makes it.
    pub(crate) command: &'static str,
    pub(crate) claims: &'static [u32],
}

/// All parts, in the order of the paper.
pub(crate) const SECTIONS: [Section; 10] = [
    Section {
        id: "part-1",
        heading: "Fig. 1: occupancy and coverage of a cell that is covered 20 %",
        figures: &["figure1"],
        numbers: &["figure1"],
        command: "cargo xtask figure 1",
        claims: &[1],
    },
    Section {
        id: "part-2",
        heading: "Fig. 2: its posterior",
        figures: &["figure2"],
        numbers: &["figure2"],
        command: "cargo xtask figure 2",
        claims: &[2],
    },
    Section {
        id: "part-3",
        heading: "Fig. 3: the sensor model, and its fit",
        figures: &["figure3"],
        numbers: &["figure3-paper", "figure3-b21r"],
        command: "cargo xtask figure 3; cargo xtask fit configs/fit/paper.ron",
        claims: &[3, 4],
    },
    Section {
        id: "part-5",
        heading: "Fig. 5: maps of the corridor: (a) counting once, (b) CL on coverage maps, (c) extended counting",
        figures: &[
            "figure5a",
            "figure5b",
            "figure5c",
            "figure5a-b21r",
            "figure5b-b21r",
            "figure5c-b21r",
        ],
        numbers: &[],
        command: "cargo xtask figure 5",
        claims: &[],
    },
    Section {
        id: "table-1",
        heading: "Table 1: coverage maps and counting in the corridor",
        figures: &[],
        numbers: &["table1"],
        command: "cargo xtask table 1",
        claims: &[5, 6, 7, 9, 20],
    },
    Section {
        id: "part-6",
        heading: "Fig. 6: scan counting up to n",
        figures: &["figure6"],
        numbers: &["figure6"],
        command: "cargo xtask figure 6",
        claims: &[8],
    },
    Section {
        id: "part-7",
        heading: "Fig. 7: the strategies; (c) path of IG, (d) path of CL",
        figures: &[
            "figure7",
            "figure7c",
            "figure7d",
            "figure7-b21r",
            "figure7c-b21r",
            "figure7d-b21r",
        ],
        numbers: &["figure7", "figure7-b21r"],
        command: "cargo xtask figure 7",
        claims: &[10, 11, 12, 13, 14, 15, 16, 19],
    },
    Section {
        id: "worlds",
        heading: "Other worlds",
        figures: &["worlds", "worlds-b21r"],
        numbers: &["worlds", "worlds-b21r"],
        command: "cargo xtask campaign configs/worlds.ron",
        claims: &[17],
    },
    Section {
        id: "oblique",
        heading: "Oblique walls",
        figures: &[],
        numbers: &[],
        command: "cargo xtask paper",
        claims: &[21],
    },
    Section {
        id: "ablation",
        heading: "One reading changed at a time, on a small world",
        figures: &[],
        numbers: &[],
        command: "cargo xtask campaign configs/ablation.ron",
        claims: &[],
    },
];

/// Returns the number or the words of the paper that a claim is about.
pub(crate) fn of_the_paper(claim: u32) -> &'static str {
    match claim {
        1 => "occupancy → 1; coverage .2",
        2 => "one peak at .2 after 30 measurements",
        3 => "“unoccupied with high likelihood” in front, “covered with high probability” at 1 m",
        5 => "0 %, 21 %, 1.5 %",
        6 => "26.6 m / 89.1 m = .30; 90.6 m / 89.1 m = 1.02",
        7 => "“some cells will be measured too often, others not often enough”",
        8 => "85 %",
        9 => "n up to 130",
        10 => "IG the fewest",
        11 => "α = 1 about as many as IG",
        12 => "CL the most",
        13 => "CL the shortest path",
        14 => "IG “an extremely long path”",
        15 => "α = .3; slightly better than IG_WIN",
        16 => "α → 0 is CL, α large is IG",
        17 => "“similar results” in other worlds",
        19 => "CL “outperforms” IG while driving",
        20 => "“more accurate”",
        _ => "no number",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_claim_has_its_part() {
        let mut claims: Vec<u32> = SECTIONS.iter().flat_map(|s| s.claims).copied().collect();
        claims.sort_unstable();
        assert_eq!(claims, (1..=17).chain(19..=21).collect::<Vec<_>>());
    }
}
