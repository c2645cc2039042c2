//! The report of `map` on a log and its map.

use crate::arguments::Map;
use crate::map_summary::MapSummary;
use crate::terminal::say;
use covmap_io::FileError;
use covmap_io::csv;
use covmap_lab::LogOverview;
use covmap_log::{Account, Readings, SensorAccount};
use std::io::Write;
use std::path::Path;

/// The largest number of sensors whose readings are printed one by one; a file has those of larger
/// rings.
const MOST_TOLD: usize = 32;

/// Returns the numbers that the map depends on, each with its source, as sentences.
pub(crate) fn taken_from(account: &Account) -> Vec<String> {
    let mut all = Vec::new();
    for sensor in &account.sensors {
        let taken = sensor.taken.iter();
        all.extend(
            taken.map(|taken| format!("{}: {} ({})", sensor.lines, taken.what, taken.source)),
        );
    }
    all.push(format!("poses: {}", account.poses));
    all
}

/// Writes the number of readings of each kind for every sensor.
pub(crate) fn write_readings(path: &Path, survey: &LogOverview) -> Result<(), FileError> {
    csv::write(path, |out| {
        writeln!(out, "lines,sensor,echoes,no_echoes,missing,skipped")?;
        for sensor in &survey.account.sensors {
            for (i, readings) in sensor.readings.iter().enumerate() {
                let Readings { echoes, no_echoes, missing, skipped } = readings;
                let lines = sensor.lines;
                writeln!(out, "{lines},{i},{echoes},{no_echoes},{missing},{skipped}")?;
            }
        }
        Ok(())
    })
}

/// Prints the report.
pub(crate) fn tell(
    arguments: &Map,
    summary: &MapSummary,
    (sensors, for_others): (&[SensorAccount], &str),
    written: &Path,
) {
    let MapSummary { world, sensor, frames, standing, scans, jumps, .. } = summary;
    say::line(format!("{world}, {sensor}: a map of {scans} scans"));
    say::line(format!(
        "  {frames} frames, {standing} of them nearer than {} m and {}° to the one used before",
        arguments.every, arguments.every_degrees
    ));
    sensors.iter().for_each(tell_readings);
    say::line(format!("  {:.1} m driven, {:.1} s", summary.path_length_m, summary.seconds));
    if *jumps > 0 {
        say::line(format!("  {jumps} jumps, too far for their time: not counted as driven"));
    }
    say::line(format!(
        "  cells: {} known, {} unknown; entropy above 0.65 nats in {:.1} % of the measured",
        summary.cells.known,
        summary.cells.unknown,
        100.0 * summary.share_entropy_above_0_65
    ));
    if let Some(file) = &summary.read_out {
        say::line(format!("  read through {}: entropies, pictures and map.pgm", file.display()));
    }
    say::line(format!("  {for_others}"));
    for line in summary.taken_from.iter().chain(&summary.remarks).chain(&summary.warning) {
        say::line(format!("  {line}"));
    }
    say::line(format!("  {}", written.display()));
}

fn tell_readings(sensor: &SensorAccount) {
    let Readings { echoes, no_echoes, missing, skipped } = sensor.total();
    let from_to = if echoes > 0 {
        format!(" ({:.2}–{:.2} m)", sensor.shortest_echo, sensor.longest_echo)
    } else {
        String::new()
    };
    say::line(format!(
        "  {}: {echoes} echoes{from_to}, {no_echoes} no echoes, {missing} missing, {skipped} skipped",
        sensor.lines
    ));
    if sensor.readings.len() > MOST_TOLD {
        return;
    }
    let tell = |name: &str, count: fn(&Readings) -> usize| {
        let counts: Vec<usize> = sensor.readings.iter().map(count).collect();
        if counts.iter().any(|count| *count > 0) {
            let counts: Vec<String> = counts.iter().map(usize::to_string).collect();
            say::line(format!("    {name} of each sensor: {}", counts.join(" ")));
        }
    };
    tell("echoes", |readings| readings.echoes);
    tell("no echoes", |readings| readings.no_echoes);
    tell("missing", |readings| readings.missing);
    tell("skipped", |readings| readings.skipped);
}
