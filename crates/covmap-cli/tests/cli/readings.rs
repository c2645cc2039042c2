//! `readings`.

use crate::typed::Shell;
use std::fmt::Write;

/// Returns the distance from a place in a room of 5 × 4 m to its wall, in a direction \[m\].
fn to_the_wall((x, y): (f64, f64), angle: f64) -> f64 {
    let along = |at: f64, low: f64, high: f64, step: f64| match step {
        s if s > 1e-12 => (high - at) / s,
        s if s < -1e-12 => (low - at) / s,
        _ => f64::INFINITY,
    };
    along(x, -1.0, 4.0, angle.cos()).min(along(y, -2.0, 2.0, angle.sin()))
}

/// Writes the log of a robot that drives through the room; every third sonar hears nothing.
pub(crate) fn room(shell: &Shell) {
    let [mut od, mut sonar, mut laser] = [const { String::new() }; 3];
    for i in 0..30u32 {
        let (t, x) = (200 * i, 0.08 * f64::from(i));
        writeln!(od, "{t} {:.0} 0 0", 1000.0 * x).unwrap();
        write!(sonar, "{t}").unwrap();
        for axis in [-90.0, -37.5, -22.5, -7.5, 7.5, 22.5, 37.5, 90.0f64] {
            let axis = axis.to_radians();
            let eye = (x + 0.175 * axis.cos(), 0.175 * axis.sin());
            let heard = if i % 3 == 2 { 5.11 } else { to_the_wall(eye, axis) };
            write!(sonar, " {:.0}", 1000.0 * heard).unwrap();
        }
        write!(laser, "{t}").unwrap();
        for beam in 0..361u32 {
            let angle = (-90.0 + 0.5 * f64::from(beam)).to_radians();
            write!(laser, " {:.0}", 1000.0 * to_the_wall((x + 0.12, 0.0), angle)).unwrap();
        }
        [&mut sonar, &mut laser].into_iter().for_each(|text| text.push('\n'));
    }
    std::fs::create_dir(shell.path("room")).unwrap();
    for (name, text) in [("od", od), ("sonar", sonar), ("laser", laser)] {
        shell.write(&format!("room/{name}.txt"), text);
    }
}

#[test]
fn the_physics_is_fitted_to_what_a_robot_heard() {
    let shell = Shell::new();
    room(&shell);
    shell.expect("survey room --out truth.ron", 0);
    let typed = shell.expect("readings room --truth truth.ron --fit 40 --out out", 0);
    let likelihood = |name: &str| -> f64 {
        let line = typed.out.lines().find(|line| line.starts_with(name)).unwrap();
        line.split(['(', ' ']).nth(2).unwrap().parse().unwrap()
    };
    let [real, simulated, fitted] = ["real", "simulated", "fitted"].map(likelihood);
    assert!(real >= fitted && fitted > simulated, "{typed:?}");
    let csv = std::fs::read_to_string(shell.path("out/readings.csv")).unwrap();
    assert!(csv.starts_with("source,to_m,readings,right,short,long,no_echo\nreal,"), "{csv}");
    for name in ["readings.svg", "readings.png"] {
        assert!(std::fs::metadata(shell.path("out").join(name)).unwrap().len() > 0, "{name}");
    }
    shell.expect("map room --config out/config.ron", 0);
}

#[test]
fn readings_need_a_survey_of_the_same_place() {
    let shell = Shell::new();
    room(&shell);
    shell.refuse("readings room --truth nowhere.ron --out out", &["nowhere.ron"]);
    shell.write("truth.ron", "(walls: [], posts: [], solids: [])");
    shell.refuse("readings room --truth truth.ron --out out", &["truth.ron: holds no wall"]);
    let far = "(walls: [(from: (50.0, 0.0), to: (51.0, 0.0), seen_from: Left, thickness: 0.1)], posts: [], solids: [])";
    shell.write("far.ron", far);
    shell.refuse("readings room --truth far.ron --out out", &["room: no frame", "surveyed"]);
    shell.write("bad.ron", "(walls: [(from: (0.0, nan), to: (1.0, 0.0), seen_from: Left, thickness: 0.1)], posts: [], solids: [])");
    shell.refuse("readings room --truth bad.ron --out out", &["bad.ron"]);
}
