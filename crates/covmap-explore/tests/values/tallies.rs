//! How often every cell was measured.

use super::{close, map_of, mission};
use covmap::Raster;
use covmap_explore::{Limits, Tally};
use covmap_sonar::{Range, Scan};
use nalgebra::Isometry2;

#[test]
fn measurements_are_counted_until_a_cell_is_explored_and_in_all() {
    // A ray from cell 0 intercepts the cells 1, 2 and 3, in each of three scans.
    let mission = mission(5, &[0.0], 3.0, Limits::default());
    let mut tally = Tally::new(&mission).unwrap();
    let pose = Isometry2::new([0.5, 0.5].into(), 0.0);
    let scan = Scan { pose, time: 0.0, ranges: vec![Range::NoEcho] };
    // ε = .6. Cell 1 is explored after the first scan, cell 2 after the second, cell 3 never.
    let (sure, vague) = (Some(vec![0.9, 0.05, 0.05]), Some(vec![0.5, 0.3, 0.2]));
    let first = map_of(&[None, sure.clone(), vague.clone(), vague.clone(), None]);
    let second = map_of(&[None, sure.clone(), sure, vague, None]);
    [&first, &second, &second].into_iter().for_each(|map| tally.add(map, &scan));
    let m = tally.finish(&Raster::from_fn(mission.grid, |cell| cell.x >= 1));
    // Discounted by 1/(1 + d/2): ⅔ once for cell 1, ½ twice for cell 2.
    close(m.until_explored, 2.0, 0.0);
    close(m.until_explored_discounted, 1.0, 1e-12);
    // 3, 3, 3 and 0: mean 9/4, variance (3 · (¾)² + (9/4)²)/4 = 27/16.
    close(m.mean, 2.25, 1e-12);
    close(m.deviation, 1.299_038_1, 1e-6);
    assert_eq!((m.least, m.most), (0.0, 3.0));
}
