//! Names of folders and files, made from the arguments.

use std::path::{Path, PathBuf};

/// Returns a folder in `out/`, named by the parts that are present.
pub(crate) fn named(parts: impl IntoIterator<Item = Option<String>>) -> PathBuf {
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    Path::new("out").join(parts.join("-"))
}

/// Returns the name of a file without its extension, for the name of a folder.
pub(crate) fn stem(file: &Path) -> String {
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    plain(&stem)
}

/// Returns a text without characters that do not suit the name of a file.
pub(crate) fn plain(text: &str) -> String {
    let plain = |c: char| if c.is_alphanumeric() || "._-".contains(c) { c } else { '_' };
    text.chars().map(plain).collect()
}

/// Returns a number for the name of a folder, unless it is the usual one.
pub(crate) fn unlike(number: f64, usual: f64) -> Option<f64> {
    number.total_cmp(&usual).is_ne().then_some(number)
}

/// Returns a number as the user typed it, without the rounding of computations.
pub(crate) fn typed(number: f64) -> f64 {
    (number * 1e6).round() / 1e6
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_plain() {
        assert_eq!(stem(Path::new("configs/my robot\n2.ron")), "my_robot_2");
        assert_eq!(typed(90.0_f64.to_radians().to_degrees()).to_string(), "90");
        let name = named(["lab".to_owned().into(), None, Some("r0.2".to_owned())]);
        assert_eq!(name, Path::new("out/lab-r0.2"));
    }
}
