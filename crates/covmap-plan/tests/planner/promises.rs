//! The chosen view-point against the promises of the literal equations.

use crate::{Setting, in_sight, setting_of, some_scans};
use covmap::Cell;
use covmap_gain::expected_changes;
use covmap_model::ModelParameters;
use covmap_plan::{PlannerParameters, Reason, Strategy};
use covmap_sonar::SonarRing;
use nalgebra::Point2;
use proptest::prelude::*;

/// Compares the chosen view-point, or that there is none, with the promises of the literal equations.
fn check_promise(s: &mut Setting, from: Cell, cell: f64, least: f64) -> Result<(), TestCaseError> {
    const OFF: f64 = 1e-3;
    let promise = |s: &Setting, at: Cell| {
        let (stencil, prediction) = (s.planner.stencil(), s.planner.prediction_at(at));
        let changes = |beam: &covmap_gain::BeamStencil| {
            expected_changes(&s.map, &s.model, stencil, beam, prediction, at)
        };
        let of_beam = |beam: &covmap_gain::BeamStencil| {
            let cells = beam.cells.iter().zip(changes(beam));
            let reasons = cells.filter_map(|(met, change)| {
                let index = s.map.grid().index(at.offset(met.dx, met.dy))?;
                #[allow(clippy::cast_possible_truncation, reason = "limits are f32")]
                let distance = met.cell_distance as f32;
                let counts = change >= cell && s.planner.gains().is_reason(index, distance);
                counts.then_some(change)
            });
            reasons.sum::<f64>()
        };
        stencil.beams.iter().map(of_beam).sum::<f64>()
    };
    match s.planner.clone().choose(&s.map, from) {
        Some(decision) if decision.passage.is_empty() && !decision.towards_ground => {
            let promise = promise(s, decision.target);
            prop_assert!(promise >= least - OFF, "{:?} promises {promise}", decision.target);
        }
        Some(_) => (),
        None => {
            for record in s.planner.candidate_table(&s.map, from).iter().step_by(17) {
                let promise = promise(s, record.cell);
                prop_assert!(promise < least + OFF, "{:?} promises {promise}", record.cell);
            }
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn who_is_chosen_promises_something(
        scans in some_scans(), strategy in prop::sample::select(vec![
            Strategy::Cl, Strategy::Ig, Strategy::IgWin { radius: 0.8 }, Strategy::IgCl { alpha: 0.3 },
        ]),
        by_cause in any::<bool>(), cell in prop_oneof![0.001..0.1f64, 0.1..1.0f64], scan in 0.0..0.3f64
    ) {
        let model = if by_cause { ModelParameters::b21r() } else { ModelParameters::by_hand() };
        let model = ModelParameters { usable_range: 1.5, ..model };
        let reason = Reason::ExpectedChange { cell, scan };
        let parameters = PlannerParameters { strategy, reason, scan_spacing: 0.3, ..in_sight() };
        let mut s = setting_of(&model, &SonarRing::b21r(), parameters);
        s.stand(0.0, 0.0);
        let home = s.map.grid().cell_at(Point2::origin()).unwrap();
        let least = cell.max(scan / (0.1 * 0.1));
        for (x, y, ranges) in scans.iter().take(3) {
            s.scan(*x, *y, ranges);
            check_promise(&mut s, home, cell, least)?;
        }
    }
}
