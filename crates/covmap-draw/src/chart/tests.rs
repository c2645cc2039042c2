//! Promises of charts.

use super::scene::{Anchor, Scene, Shape};
use super::*;
use crate::picture::{Rgb, text::text_width};
use proptest::prelude::*;

fn chart(series: Vec<Series>) -> Chart {
    Chart {
        title: "Error".into(),
        subtitle: String::new(),
        x: ChartAxis::new("driven [m]"),
        y: ChartAxis::new("error"),
        series,
    }
}

fn series(name: &str, points: &[(f64, f64)]) -> Series {
    let points = points.iter().map(|(x, y)| ChartPoint::new(*x, *y)).collect();
    Series { name: name.into(), points, line: true, marks: true }
}

fn heat_map(values: Vec<f64>) -> HeatMap {
    HeatMap {
        title: "p(c | d)".into(),
        subtitle: String::new(),
        x: ChartAxis::new("distance [m]"),
        y: ChartAxis::new("coverage"),
        value: ChartAxis::new("probability"),
        x_edges: HeatMap::edges(&[0.5, 1.5, 2.5]),
        y_edges: HeatMap::edges(&[0.25, 0.75]),
        values,
        color_map: ColorMap::Viridis,
    }
}

#[test]
fn names_are_escaped_in_svg() {
    let mut chart = chart(vec![series("a<b> & \"c\"\u{1}", &[(0.0, 1.0), (1.0, 2.0)])]);
    chart.title = "<script>".into();
    chart.x.label = "d & e [m]".into();
    let svg = chart.to_svg();
    for expected in ["&lt;script&gt;", "d &amp; e [m]", "a&lt;b&gt; &amp; &quot;c&quot;\u{fffd}"] {
        assert!(svg.contains(expected), "{expected} in {svg}");
    }
    assert!(!svg.contains("<script>") && svg.contains("sans-serif"));
}

#[test]
fn the_same_data_make_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let chart = chart(vec![series("one", &[(0.0, 1.0), (0.3, 7.0), (1.0, 2.0)])]);
    let figure = Figure {
        panels: vec![chart.into(), heat_map(vec![0.1, 0.2, 0.3, 0.4, 0.5, 0.6]).into()],
        columns: 2,
        ..Figure::default()
    };
    let save = |name: &str| {
        let path = |end: &str| folder.path().join(format!("{name}.{end}"));
        figure.save(path("svg"), path("png")).unwrap();
        (std::fs::read(path("svg")).unwrap(), std::fs::read(path("png")).unwrap())
    };
    let (svg, png) = save("first");
    assert!((svg.clone(), png.clone()) == save("second"));
    assert!(svg.starts_with(b"<svg") && png.starts_with(b"\x89PNG"));
    let error = figure.save(folder.path().join("none/a.svg"), folder.path().join("a.png"));
    let error = error.unwrap_err().to_string();
    assert!(error.contains("none/a.svg: cannot be written"), "{error}");
}

#[test]
fn points_that_cannot_be_drawn_break_their_line() {
    let whole = chart(vec![series("", &[(0.0, 1.0), (1.0, 2.0), (2.0, 1.0), (3.0, 2.0)])]);
    let lines = |chart: &Chart| chart.to_svg().matches("stroke-width=\"2\"").count();
    assert_eq!(lines(&whole), 1);
    let mut broken = whole.clone();
    broken.series[0].points.insert(2, ChartPoint::new(1.5, f64::NAN));
    assert_eq!(lines(&broken), 2);
    assert_eq!(broken.to_svg().matches("<circle").count(), 4);
}

#[test]
fn a_chart_without_points_says_so() {
    let nothing = [(f64::NAN, 1.0), (1.0, f64::INFINITY)];
    for series in [vec![], vec![series("a", &[])], vec![series("a", &nothing)]] {
        assert!(chart(series).to_svg().contains("no data"));
    }
    assert!(!chart(vec![series("a", &[(1.0, 1.0)])]).to_svg().contains("no data"));
}

#[test]
fn a_bar_is_drawn_as_far_as_the_frame() {
    let mut chart = chart(vec![series("", &[(1.0, 5.0)])]);
    let pieces = |chart: &Chart| chart.to_svg().matches("stroke-width=\"1.2\"").count();
    assert_eq!(pieces(&chart), 0, "no bar without an error");
    let point = &mut chart.series[0].points[0];
    (point.low, point.high) = (4.0, 6.0);
    assert_eq!(pieces(&chart), 3, "a bar and two caps");
    chart.y.to = Some(5.5);
    assert_eq!(pieces(&chart), 2, "the upper end is cut off");
    chart.series[0].points[0].low = f64::NEG_INFINITY;
    assert_eq!(pieces(&chart), 1);
}

#[test]
fn a_hollow_mark_has_the_colour_of_its_series_as_its_rim() {
    for index in 0..8 {
        let mut all = vec![series("", &[]); index];
        all.push(Series { line: false, ..series("", &[(1.0, 5.0)]) });
        let mark = |chart: &Chart| {
            let scene = Figure::of(chart.clone()).lay_out();
            let shape = scene.shapes.into_iter().find_map(|shape| match shape {
                Shape::Disc { fill, rim, .. } | Shape::Polygon { fill, rim, .. } => {
                    Some((fill, rim))
                }
                _ => None,
            });
            shape.unwrap()
        };
        let mut chart = chart(all);
        let (color, white) = mark(&chart);
        assert!(color != Rgb::WHITE && white == Rgb::WHITE);
        chart.series[index].points[0].hollow = true;
        assert_eq!(mark(&chart), (white, color), "series {index}");
    }
}

#[test]
fn panels_share_a_legend_if_their_series_are_the_same() {
    let panel = |names: &[&str]| -> Panel {
        chart(names.iter().map(|name| series(name, &[(0.0, 1.0)])).collect()).into()
    };
    let count = |panels: Vec<Panel>| {
        let figure = Figure { panels, columns: 2, ..Figure::default() };
        figure.to_svg().matches(">alpha<").count()
    };
    assert_eq!(count(vec![panel(&["alpha", "beta"]), panel(&["alpha"])]), 1);
    assert_eq!(count(vec![panel(&["alpha", "beta"]), panel(&["beta", "alpha"])]), 2);
}

#[test]
fn a_cell_of_a_heat_map_without_a_value_is_not_drawn() {
    let blocks = |values: &[f64]| heat_map(values.to_vec()).to_svg().matches("crispEdges").count();
    let all = blocks(&[0.1, 0.2, 0.3, 0.4, 0.5, 0.6]);
    assert_eq!(all - blocks(&[0.1, f64::NAN, 0.3, 0.4, 0.5]), 2);
    assert_eq!(all - blocks(&[0.1, 0.1, 0.3, 0.4, 0.5, 0.6]), 1, "neighbours are joined");
}

#[test]
fn figures_of_any_number_of_panels_are_drawn() {
    for panels in [0, 1, 2, 13, 200] {
        for columns in [0, 1, 5, usize::MAX] {
            let panels = vec![Panel::Chart(chart(vec![])); panels];
            let figure = Figure { panels, columns, ..Figure::default() };
            let canvas = figure.lay_out().paint();
            assert!(canvas.width() <= 8000 && canvas.height() <= 8000);
        }
    }
}

/// Returns whether a shape is drawn within the drawing.
fn lies_in(shape: &Shape, scene: &Scene) -> bool {
    let inside =
        |[x, y]: &[f32; 2]| (0.0..=scene.width).contains(x) && (0.0..=scene.height).contains(y);
    match shape {
        Shape::Line { points, .. } => points.iter().all(inside),
        Shape::Polygon { corners, .. } => corners.iter().all(inside),
        Shape::Disc { center, .. } => inside(center),
        Shape::Block { at, size, .. } => inside(at) && inside(&[at[0] + size[0], at[1] + size[1]]),
        Shape::Text { text, size, at, anchor, turned, .. } => {
            let width = text_width(text, *size);
            let (before, after) = match anchor {
                Anchor::Start => (0.0, width),
                Anchor::Middle => (width / 2.0, width / 2.0),
                Anchor::End => (width, 0.0),
            };
            let [x, y] = *at;
            if *turned {
                inside(&[x, y + before]) && inside(&[x, y - after])
            } else {
                inside(&[x - before, y]) && inside(&[x + after, y])
            }
        }
    }
}

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        proptest::num::f64::ANY,
        -10.0..10.0,
        Just(0.0),
        Just(1.0),
        Just(f64::MAX),
        Just(f64::NAN)
    ]
}

#[test]
fn values_that_have_names_are_called_so() {
    let names = vec!["CL".to_owned(), "IG_WIN\n(2.0)".to_owned()];
    let points = vec![ChartPoint::new(1.0, 3.0), ChartPoint::new(2.0, 4.0)];
    let series = vec![Series { name: "scans".into(), points, line: false, marks: true }];
    let x = ChartAxis::named("strategy", names);
    let chart = Chart { x, y: ChartAxis::new("scans"), series, ..Chart::default() };
    let svg = chart.to_svg();
    assert!(
        ["CL", "IG_WIN", "(2.0)"].iter().all(|name| svg.contains(&format!(">{name}<"))),
        "{svg}"
    );
    assert!(!svg.contains(">1.5<"));
}

fn any_axis() -> impl Strategy<Value = ChartAxis> {
    let end = || proptest::option::of(number());
    (".*", end(), end(), any::<bool>()).prop_map(|(label, from, to, logarithmic)| ChartAxis {
        label,
        from,
        to,
        logarithmic,
        names: Vec::new(),
    })
}

fn any_series() -> impl Strategy<Value = Series> {
    let point = (number(), number(), number(), number(), any::<bool>())
        .prop_map(|(x, y, low, high, hollow)| ChartPoint { x, y, low, high, hollow });
    (".*", proptest::collection::vec(point, 0..8), any::<bool>(), any::<bool>())
        .prop_map(|(name, points, line, marks)| Series { name, points, line, marks })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn any_numbers_make_a_chart(
        title in ".*",
        x in any_axis(),
        y in any_axis(),
        series in proptest::collection::vec(any_series(), 0..4),
    ) {
        let subtitle = title.clone();
        let figure = Figure::of(Chart { title, subtitle, x, y, series });
        let scene = figure.lay_out();
        prop_assert!(scene.shapes.iter().all(|shape| lies_in(shape, &scene)));
        scene.to_svg();
        scene.paint();
    }

    #[test]
    fn any_numbers_make_a_heat_map(
        axes in (any_axis(), any_axis(), any_axis()),
        x_edges in proptest::collection::vec(number(), 0..5),
        y_edges in proptest::collection::vec(number(), 0..5),
        values in proptest::collection::vec(number(), 0..20),
    ) {
        let (x, y, value) = axes;
        let map = HeatMap { x, y, value, x_edges, y_edges, values, ..heat_map(Vec::new()) };
        let scene = Figure::of(map).lay_out();
        prop_assert!(scene.shapes.iter().all(|shape| lies_in(shape, &scene)));
        scene.to_svg();
        scene.paint();
    }
}
