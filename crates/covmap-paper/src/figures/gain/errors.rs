//! The errors of the fast gains, by cause: proved, probed, and measured.

use super::moment::Moment;
use super::one_cell::{gains, kinds};
use super::style::{
    BLUE, GREEN, GREY_INK, LIGHT, ORANGE, PALE, SMALL, TEXT, VERMILION, count, small,
};
use crate::error::{PaperError, Result};
use covmap_draw::{Drawing, Rgb, TextAnchor};
use covmap_gain::{GAIN_TOLERANCE, NEGLIGIBLE, TableErrors};
use rayon::ThreadPoolBuilder;

const WIDTH: f64 = 1060.0;
const LEFT: f64 = 430.0;
const RIGHT: f64 = 960.0;
const ROW: f64 = 25.0;
/// The ends of the axis.
const LEAST: f64 = 1e-12;
const MOST: f64 = 1e-3;
/// The number of view-points that are compared with the literal equations.
const COMPARED: usize = 80;

/// A cause of errors in gains.
struct ErrorRow {
    what: String,
    color: Rgb,
    /// Measured values; the largest is what counts.
    measured: Vec<f64>,
    /// The allowed error: for most rings, and at most.
    allowed: Option<(f64, f64)>,
}

impl ErrorRow {
    fn worst(&self) -> f64 {
        self.measured.iter().copied().fold(0.0, f64::max)
    }
}

pub(super) fn draw(by_cause: &Moment, by_product: &Moment, quick: bool) -> Result<Drawing> {
    let sections = [
        (
            "PROVED: any map, any histogram",
            "of the largest gain of a decision",
            proved(by_cause, by_product)?,
        ),
        (
            "PROBED: the worst of the histograms that tables are made with",
            "of the largest gain of a cell",
            probed(by_cause, by_product, quick)?,
        ),
        (
            "MEASURED: E[I] less the equations as printed, view-point by view-point",
            "of the largest gain of the decision",
            measured(by_cause, by_product, quick),
        ),
    ];
    let rows: usize = sections.iter().map(|(_, _, rows)| rows.len()).sum();
    let bounds = [bounds(by_product, "Eq. (9)")?, bounds(by_cause, "By cause")?];
    let height = 70.0 + count(rows) * ROW + 3.0 * 46.0 + 40.0 + 34.0 + 2.0 * 22.0 + 30.0;
    let mut drawing = Drawing::new(
        "What a fast gain is off: proved and probed apart",
        &by_cause.words(),
        [WIDTH, height],
    );
    let mut y = drawing.top();
    let top = y;
    let bottom = y + count(rows) * ROW + 3.0 * 46.0;
    draw_axis(&mut drawing, (top + 30.0, bottom));
    for (title, unit, rows) in &sections {
        drawing.block([0.0, y], [WIDTH, 32.0], Rgb::WHITE);
        drawing.text(title, 14.5, [18.0, y + 20.0], TextAnchor::Start, Rgb::INK);
        let at = [26.0 + Drawing::text_width(title, 14.5), y + 20.0];
        drawing.text(&format!("in parts {unit}"), SMALL, at, TextAnchor::Start, GREY_INK);
        y += 34.0;
        for row in rows {
            draw_row(&mut drawing, row, y);
            y += ROW;
        }
        y += 12.0;
    }
    y = bottom + 52.0;
    draw_key(&mut drawing, y);
    for line in bounds {
        y += 22.0;
        drawing.text(&line, TEXT, [18.0, y + 8.0], TextAnchor::Start, Rgb::INK);
    }
    Ok(drawing)
}

/// Returns the part of the axis at which a number lies.
fn at(value: f64) -> f64 {
    let share = libm::log(value.max(LEAST) / LEAST) / libm::log(MOST / LEAST);
    LEFT + (RIGHT - LEFT) * share.clamp(0.0, 1.0)
}

fn draw_axis(drawing: &mut Drawing, (top, bottom): (f64, f64)) {
    for exponent in -12..=-3 {
        let x = at(libm::pow(10.0, f64::from(exponent)));
        drawing.line(&[[x, top], [x, bottom]], LIGHT, 1.0);
        let label = format!("1e{exponent}");
        drawing.text(&label, SMALL, [x, bottom + 16.0], TextAnchor::Middle, Rgb::INK);
    }
    let x = at(GAIN_TOLERANCE);
    let text = "what a decision tolerates";
    drawing.text(text, SMALL, [x, bottom + 31.0], TextAnchor::Middle, VERMILION);
}

fn draw_row(drawing: &mut Drawing, row: &ErrorRow, y: f64) {
    drawing.text(&row.what, TEXT, [LEFT - 12.0, y + 15.0], TextAnchor::End, Rgb::INK);
    drawing.block([LEFT, y + 3.0], [RIGHT - LEFT, ROW - 6.0], PALE);
    let worst = row.worst();
    if row.measured.len() > 1 {
        for value in row.measured.iter().filter(|value| **value > 0.0) {
            let x = at(*value);
            drawing.line(&[[x, y + 6.0], [x, y + ROW - 6.0]], row.color, 0.7);
        }
        let x = at(worst);
        drawing.line(&[[x, y + 3.0], [x, y + ROW - 3.0]], row.color, 2.6);
    } else if worst > 0.0 {
        drawing.block([LEFT, y + 5.0], [at(worst) - LEFT, ROW - 10.0], row.color);
    }
    if worst <= 0.0 {
        let text = if row.allowed.is_some() { "0: nothing is" } else { "0: the same bits" };
        drawing.text(text, SMALL, [LEFT + 8.0, y + 15.5], TextAnchor::Start, row.color);
    } else {
        let at = [RIGHT + 10.0, y + 15.0];
        drawing.text(&small(worst), TEXT, at, TextAnchor::Start, Rgb::INK);
    }
    let x = at(GAIN_TOLERANCE);
    drawing.dashed(&[[x, y], [x, y + ROW]], VERMILION, 1.6);
    if let Some((mostly, most)) = row.allowed {
        let middle = y + 0.5 * ROW;
        drawing.line(&[[at(mostly), middle], [at(most), middle]], Rgb::INK, 1.0);
        for x in [at(mostly), at(most)] {
            drawing.line(&[[x, y + 2.0], [x, y + ROW - 2.0]], Rgb::INK, 2.0);
        }
    }
}

fn draw_key(drawing: &mut Drawing, y: f64) {
    drawing.line(&[[24.0, y - 12.0], [24.0, y + 3.0]], Rgb::INK, 2.0);
    let text = "what it may be; from one to the other by ring";
    drawing.text(text, TEXT, [34.0, y], TextAnchor::Start, Rgb::INK);
    drawing.block([362.0, y - 10.0], [26.0, 12.0], ORANGE);
    drawing.text("the worst that was met", TEXT, [396.0, y], TextAnchor::Start, Rgb::INK);
    drawing.line(&[[592.0, y - 11.0], [592.0, y + 2.0]], BLUE, 0.8);
    drawing.line(&[[600.0, y - 11.0], [600.0, y + 2.0]], BLUE, 0.8);
    drawing.line(&[[608.0, y - 12.0], [608.0, y + 3.0]], BLUE, 2.6);
    let text = "one view-point each, and the worst";
    drawing.text(text, TEXT, [618.0, y], TextAnchor::Start, Rgb::INK);
}

/// Returns the errors that are zero to the last bit, or bounded for any map.
fn proved(by_cause: &Moment, by_product: &Moment) -> Result<Vec<ErrorRow>> {
    let row = |what: &str, measured: f64, allowed| ErrorRow {
        what: what.into(),
        color: GREEN,
        measured: vec![measured],
        allowed,
    };
    let mut rows = Vec::new();
    let both = |of: &dyn Fn(&Moment) -> Result<f64>| -> Result<f64> {
        Ok(of(by_cause)?.max(of(by_product)?))
    };
    rows.push(row("horizon, staleness: kept against fresh", both(&kept_against_fresh)?, None));
    rows.push(row("threads: one against four", both(&one_thread_against_four)?, None));
    let left_out = both(&|moment| Ok(left_out(moment)))?;
    rows.push(row("outcomes left out: all of a beam’s", left_out, {
        let outcomes = by_cause.stencil.outcomes();
        let most = NEGLIGIBLE * count(outcomes);
        Some((most, most))
    }));
    Ok(rows)
}

/// Returns the difference between the gains kept through a run and those of a fresh cache of the
/// whole map.
fn kept_against_fresh(moment: &Moment) -> Result<f64> {
    let all = moment.view_points();
    let (mut kept, mut fresh) = (moment.gains.clone(), moment.fresh_cache()?);
    kept.refresh_gains(&all);
    fresh.refresh_gains(&all);
    let off = |cell| {
        let index = moment.index(cell);
        (kept.gain(index) - fresh.gain(index)).abs()
    };
    Ok(moment.candidates.iter().map(|c| off(c.cell)).fold(0.0, f64::max) / largest(moment))
}

fn one_thread_against_four(moment: &Moment) -> Result<f64> {
    let by = |threads: usize| -> Result<Vec<f64>> {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build()?;
        pool.install(|| {
            let mut cache = moment.fresh_cache()?;
            cache.refresh_gains(&moment.view_points());
            Ok(moment.candidates.iter().map(|c| cache.gain(moment.index(c.cell))).collect())
        })
    };
    let (one, four) = (by(1)?, by(4)?);
    let off = one.iter().zip(&four).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    Ok(off / largest(moment))
}

/// Returns the largest probability left out of a beam, summed over its outcomes.
fn left_out(moment: &Moment) -> f64 {
    let beams = 0..moment.stencil.beams.len();
    let of_beam = |view_point, beam| {
        let likelihood = moment.likelihood(super::moment::Seen { view_point, beam });
        let all = (0..moment.stencil.outcomes()).map(|k| likelihood.probability(k));
        all.filter(|p| *p <= NEGLIGIBLE).sum::<f64>()
    };
    let of_all = moment.candidates.iter().flat_map(|c| beams.clone().map(|b| of_beam(c.cell, b)));
    of_all.fold(0.0, f64::max)
}

fn largest(moment: &Moment) -> f64 {
    moment.candidates.iter().map(|c| c.gain.abs()).fold(1e-300, f64::max)
}

/// Returns the errors of the tables, for the worst of some histograms.
fn probed(by_cause: &Moment, by_product: &Moment, quick: bool) -> Result<Vec<ErrorRow>> {
    let errors = TableErrors::probed(&by_product.model, 0.0)
        .ok_or(PaperError::Missing("tables of the update by Eq. (9)"))?;
    let row = |what: String, measured, allowed| ErrorRow {
        what,
        color: ORANGE,
        measured: vec![measured],
        allowed,
    };
    let allowed = |part: f64| Some((part * errors.allowed, part * errors.allowed_in_small_rings));
    let half = 0.5 * errors.allowed;
    let mixtures = format!("Eq. (9): {} readings mixed of {}", errors.readings, errors.basis);
    let mut off_share = 0.0f64;
    for kind in kinds(by_cause.map.bins()) {
        let gained = gains(&by_cause.config, &kind, if quick { 6 } else { 40 })?;
        let most = gained.iter().map(|g| g.literal.abs()).fold(1e-300, f64::max);
        let worst = gained.iter().map(|g| (g.fast - g.literal).abs()).fold(0.0, f64::max);
        off_share = off_share.max(worst / most);
    }
    Ok(vec![
        row("Eq. (9): over range and distance".into(), errors.interpolation, allowed(1.0)),
        row(mixtures, errors.mixtures, Some((half, half))),
        row("Eq. (9): fewer sums beyond a ring".into(), errors.fewer_sums, allowed(0.3)),
        row("Eq. (9): all of these together".into(), errors.all, None),
        row("Eq. (9): one reading in single precision".into(), errors.single_precision, None),
        row("by cause: three kinds of cells in front".into(), off_share, None),
    ])
}

/// Returns the errors of E\[I\] against the equations as printed.
fn measured(by_cause: &Moment, by_product: &Moment, quick: bool) -> Vec<ErrorRow> {
    let of = |what: &str, moment: &Moment| {
        let compared = if quick { 4 } else { COMPARED };
        let step = (moment.candidates.len() / compared).max(1);
        let some = moment.candidates.iter().step_by(step);
        let off = |c: &covmap_plan::CandidateRecord| {
            (c.gain - moment.literal_gain(c.cell)).abs() / largest(moment)
        };
        let measured: Vec<f64> = some.map(off).collect();
        let what = format!("{what}: {} view-points", measured.len());
        ErrorRow { what, color: BLUE, measured, allowed: None }
    };
    vec![of("E[I] by Eq. (9)", by_product), of("E[I] by cause", by_cause)]
}

/// Describes the distance of gains below their bounds, in a sentence.
fn bounds(moment: &Moment, update: &str) -> Result<String> {
    let (mut bounds, mut gains) = (moment.fresh_cache()?, moment.fresh_cache()?);
    let all = moment.view_points();
    bounds.refresh_bounds(&all);
    gains.refresh_gains(&all);
    let indices = moment.candidates.iter().map(|c| moment.index(c.cell));
    let shares: Vec<f64> = indices.map(|index| gains.gain(index) / bounds.gain(index)).collect();
    let above = shares.iter().filter(|share| **share > 1.0).count();
    let closest = shares.iter().copied().fold(0.0, f64::max);
    Ok(format!(
        "Bounds, probed. {update}: of {} gains {above} lie above their bound; the largest share of a \
         bound that a gain reaches is {closest:.2}.",
        shares.len()
    ))
}
