//! One run.

use crate::error::Result;
use crate::paths::{Paths, driven, millimetres, rounded};
use crate::plan::{Job, Plan};
use crate::record::{RunRecord, Value, values};
use covmap_explore::{Ending, Event, TraceHasher, View};
use covmap_lab::{Accuracy, Experiment, LabError, Tally, Truth};
use covmap_world::World;
use cpu_time::ThreadTime;
use indexmap::IndexMap;
use std::ops::ControlFlow;
use std::time::Duration;

/// Least distance after which the share of explored cells is evaluated again \[m\].
const LOOK_AFTER: f64 = 0.5;
/// Least share of the path so far after which the share of explored cells is evaluated again.
const LOOK_AFTER_SHARE: f64 = 0.01;

/// Hook that receives every event of a run, and decides whether the run goes on.
type Watch<'a> = dyn FnMut(&Event, &View<'_>) -> ControlFlow<()> + 'a;

/// The results of a run that came to its end.
pub(crate) struct Done {
    pub record: RunRecord,
    pub paths: Option<Paths>,
}

/// Does one run; `None` if `watch` stops it before its end.
pub(crate) fn execute(plan: &Plan, job: &Job, watch: &mut Watch<'_>) -> Result<Option<Done>> {
    let (world, experiment) = (&plan.cases[job.case].world, plan.experiment(job)?);
    let key = job.planned.key.clone();
    let out = measure(world, &experiment, plan.keep_paths, watch)?;
    Ok(out.map(|(values, times, paths)| Done { record: RunRecord { key, values, times }, paths }))
}

type Measured = (IndexMap<String, Value>, IndexMap<String, f64>, Option<Paths>);

fn measure(
    world: &World,
    experiment: &Experiment,
    keep_paths: bool,
    watch: &mut Watch<'_>,
) -> Result<Option<Measured>> {
    let begun = ThreadTime::now();
    let mission = &experiment.mission;
    let truth = Truth::new(world, mission);
    let prepared = begun.elapsed();
    let mut hasher = TraceHasher::default();
    hasher.add(&experiment.header(world));
    let mut tally = Tally::new(mission).map_err(LabError::from)?;
    let mut deciding = Duration::ZERO;
    let (mut explored, mut look_at) = (Vec::new(), 0.0);
    // A run has its own thread, and its time is the computing time of this thread, without the time
    // of this hook.
    let mut aside = Duration::ZERO;
    let begun = ThreadTime::now();
    let mut last = ThreadTime::now();
    let run = experiment.explore(world, &mut |event, view| {
        let now = ThreadTime::now();
        hasher.add_event(event);
        match event {
            Event::Decision { .. } => deciding += now.duration_since(last),
            Event::Scan { scan, .. } => tally.add(view.map, scan),
            Event::Bump { .. } | Event::End { .. } => {}
        }
        let over = matches!(event, Event::End { .. });
        if keep_paths && (view.path_length >= look_at || over) {
            let share = truth.share_explored(view.map, mission);
            explored.push((rounded(view.path_length, 1e3), rounded(share, 1e6)));
            look_at = view.path_length + LOOK_AFTER.max(LOOK_AFTER_SHARE * view.path_length);
        }
        let flow = watch(event, view);
        last = ThreadTime::now();
        aside += last.duration_since(now);
        flow
    });
    let run = run.map_err(LabError::from)?;
    if run.ending == Ending::Interrupted {
        return Ok(None);
    }
    let seconds = (begun.elapsed().saturating_sub(aside)).as_secs_f64();
    let scoring = ThreadTime::now();
    hasher.add_bytes(&run.map.to_bytes());
    let scored = truth.scored_cells(world, mission, &run);
    let accuracy = Accuracy::new(&truth, mission, &run.map, &scored);
    let hash = hasher.finish();
    let summary = experiment.summary((world, &truth), (&run, &run.map), (seconds, hash));
    let mut all = values(&summary)?;
    let extra = accuracy.named().into_iter().chain(tally.finish(&truth.observable).named());
    all.extend(extra.map(|(name, number)| (name.to_owned(), Value::Number(number))));
    let scoring = prepared + scoring.elapsed() + aside;
    let times = [
        ("seconds", seconds),
        ("deciding_seconds", deciding.as_secs_f64()),
        ("scoring_seconds", scoring.as_secs_f64()),
    ];
    let times = times.map(|(name, time)| (name.to_owned(), time)).into_iter().collect();
    let place = |scan: &covmap_sonar::Scan| millimetres(scan.pose.translation.vector.into());
    let paths = keep_paths.then(|| Paths {
        driven: driven(&run.trajectory),
        scans: run.scans.iter().map(place).collect(),
        explored,
    });
    Ok(Some((all, times, paths)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::NUMBERS;
    use covmap_explore::Limits;
    use covmap_lab::Config;
    use covmap_world::{Extent, Scenario, Surface};

    #[test]
    fn the_numbers_of_a_run_are_those_that_are_named() {
        let extent = Extent { width: 1.0, height: 1.0 };
        let closet = Scenario { name: "closet".into(), extent, start: None, obstacles: vec![] };
        let config = Config { resolution: 0.2, ..Config::b21r() };
        let limits = Limits { max_scans: Some(1), ..Limits::default() };
        let world = World::from_scenario(&closet, Surface::Rough).unwrap();
        let experiment = Experiment::new(&world, &config, None, limits, 1).unwrap();
        let go_on = &mut |_: &Event, _: &View<'_>| ControlFlow::Continue(());
        let (values, ..) = measure(&world, &experiment, false, go_on).unwrap().unwrap();
        let is_number = |(_, value): &(&String, &Value)| matches!(value, Value::Number(_));
        let numbers: Vec<&str> =
            values.iter().filter(is_number).map(|(name, _)| name.as_str()).collect();
        assert_eq!(numbers, NUMBERS);
    }
}
