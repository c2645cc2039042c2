//! The numbers of a strategy, each in its own column, so that a user can sort tables by them.

use covmap_plan::Strategy;

/// Columns of a strategy's numbers in all tables: α of IG_CL, the radius of IG_WIN \[m\], and n and
/// d0 \[m\] of COUNT.
pub const PARAMETERS: [&str; 4] = ["alpha", "radius", "times", "half_distance"];

/// Returns the fields of a strategy in [`PARAMETERS`]; empty where the strategy has no such number.
pub fn parameters(strategy: &Strategy) -> [String; PARAMETERS.len()] {
    let (mut alpha, mut radius, mut times, mut half_distance) = (None, None, None, None);
    match *strategy {
        Strategy::Cl | Strategy::Ig => {}
        Strategy::IgWin { radius: window } => radius = Some(window),
        Strategy::IgCl { alpha: weight } => alpha = Some(weight),
        Strategy::Count { times: n, half_distance: half } => {
            (times, half_distance) = (Some(n), half);
        }
    }
    [alpha, radius, times, half_distance]
        .map(|number| number.map(|number| number.to_string()).unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_of_a_strategy_has_its_column() {
        for (strategy, expected) in [
            ("CL", ",,,"),
            ("IG", ",,,"),
            ("IG_WIN:2.5", ",2.5,,"),
            ("IG_CL:0.3", "0.3,,,"),
            ("COUNT:50", ",,50,"),
            ("COUNT:50:2", ",,50,2"),
        ] {
            assert_eq!(parameters(&strategy.parse().unwrap()).join(","), expected, "{strategy}");
        }
    }
}
