//! Colours and scales of colours.

/// A colour by its red, green and blue, each 0..=255 (sRGB).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rgb(pub u8, pub u8, pub u8);

impl Rgb {
    /// Black.
    pub const BLACK: Rgb = Rgb(0, 0, 0);
    /// White.
    pub const WHITE: Rgb = Rgb(255, 255, 255);
    /// Nearly black: for text and frames.
    pub const INK: Rgb = Rgb(38, 44, 52);
    /// Grey: for subtitles.
    pub(crate) const GREY_INK: Rgb = Rgb(92, 102, 114);
    /// A lighter grey: for the frames of scales and charts.
    pub(crate) const FRAME: Rgb = Rgb(120, 130, 142);
    /// A light blue-grey: for unknown cells.
    pub const UNKNOWN: Rgb = Rgb(198, 211, 226);
    /// A strong blue: for the path of a robot.
    pub const BLUE: Rgb = Rgb(28, 98, 184);
    /// A strong orange: for the place under consideration.
    pub const ORANGE: Rgb = Rgb(230, 126, 22);
    /// A strong green: for a beginning.
    pub const GREEN: Rgb = Rgb(38, 142, 76);
    /// A strong red: for an end.
    pub const RED: Rgb = Rgb(204, 50, 46);

    /// Returns the colour at `t` in [0, 1] on the way from this one to another.
    #[must_use]
    pub fn mix(self, other: Rgb, t: f64) -> Rgb {
        let t = if t.is_nan() { 0.0 } else { t.clamp(0.0, 1.0) };
        let mix = |a: u8, b: u8| {
            let value = f64::from(a) + t * (f64::from(b) - f64::from(a));
            #[allow(clippy::cast_possible_truncation, reason = "between two bytes")]
            let byte = value.round() as u8;
            byte
        };
        Rgb(mix(self.0, other.0), mix(self.1, other.1), mix(self.2, other.2))
    }
}

/// A scale of colours over [0, 1].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColorMap {
    /// Dark violet over green to yellow, ever brighter: readable in grey and for the
    /// colour-blind. For entropies.
    Viridis,
    /// Black over purple and orange to pale yellow, ever brighter. For gains.
    Inferno,
    /// White to black. For coverage.
    Grey,
    /// Blue over near-white to red, brightest in the middle. For differences with a sign.
    Diverging,
}

const VIRIDIS: [Rgb; 9] = [
    Rgb(68, 1, 84),
    Rgb(71, 45, 123),
    Rgb(59, 82, 139),
    Rgb(44, 114, 142),
    Rgb(33, 145, 140),
    Rgb(40, 174, 128),
    Rgb(94, 201, 98),
    Rgb(173, 220, 48),
    Rgb(253, 231, 37),
];
const INFERNO: [Rgb; 9] = [
    Rgb(0, 0, 4),
    Rgb(32, 17, 75),
    Rgb(87, 16, 110),
    Rgb(136, 34, 106),
    Rgb(188, 55, 84),
    Rgb(227, 89, 51),
    Rgb(249, 140, 10),
    Rgb(249, 201, 50),
    Rgb(252, 255, 164),
];
const GREY: [Rgb; 2] = [Rgb::WHITE, Rgb(20, 20, 24)];
const DIVERGING: [Rgb; 5] = [
    Rgb(33, 80, 158),
    Rgb(128, 170, 214),
    Rgb(245, 245, 242),
    Rgb(230, 150, 122),
    Rgb(172, 32, 42),
];

impl ColorMap {
    /// Returns the colour at `t`; below 0 that of 0, above 1 that of 1, and for NaN [`Rgb::UNKNOWN`].
    pub fn color(self, t: f64) -> Rgb {
        let anchors: &[Rgb] = match self {
            Self::Viridis => &VIRIDIS,
            Self::Inferno => &INFERNO,
            Self::Grey => &GREY,
            Self::Diverging => &DIVERGING,
        };
        if t.is_nan() {
            return Rgb::UNKNOWN;
        }
        let along = t.clamp(0.0, 1.0) * (anchors.len() - 1) as f64;
        #[allow(
            clippy::cast_possible_truncation,
            reason = "at least 0, at most the number of anchors"
        )]
        let from = (along as usize).min(anchors.len() - 2);
        let t = along - from as f64;
        anchors[from].mix(anchors[from + 1], t)
    }
}

/// Returns the colour of a coverage: white for a free cell, black for a full one, and
/// [`Rgb::UNKNOWN`], which is no grey, for an unknown one.
pub fn coverage_color(coverage: Option<f64>) -> Rgb {
    coverage.map_or(Rgb::UNKNOWN, |coverage| ColorMap::Grey.color(coverage))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn brightness(Rgb(r, g, b): Rgb) -> f64 {
        0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b)
    }

    #[test]
    fn a_scale_of_colours_is_ordered_by_brightness() {
        for map in [ColorMap::Viridis, ColorMap::Inferno] {
            let values: Vec<f64> =
                (0..=64).map(|i| brightness(map.color(f64::from(i) / 64.0))).collect();
            assert!(values.windows(2).all(|pair| pair[0] < pair[1]), "{map:?}");
        }
    }

    #[test]
    fn a_scale_reaches_its_ends_and_stops_there() {
        assert_eq!(ColorMap::Viridis.color(-7.0), VIRIDIS[0]);
        assert_eq!(ColorMap::Viridis.color(1.0), VIRIDIS[8]);
        assert_eq!(ColorMap::Inferno.color(f64::INFINITY), INFERNO[8]);
        assert_eq!(ColorMap::Grey.color(f64::NAN), Rgb::UNKNOWN);
    }

    #[test]
    fn unknown_is_no_coverage() {
        let unknown = coverage_color(None);
        assert_eq!(coverage_color(Some(0.0)), Rgb::WHITE);
        assert!((0..=100).all(|i| coverage_color(Some(f64::from(i) / 100.0)) != unknown));
    }
}
