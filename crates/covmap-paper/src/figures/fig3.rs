//! Fig. 3: the answer of the sensor model to an echo from 1 m.

use crate::echo::{RANGE, column};
use crate::error::Result;
use covmap::bin_coverage;
use covmap_draw::FigureFolder;
use covmap_draw::{ChartAxis, ColorMap, Figure, HeatMap};
use covmap_lab::{echo_distances, echo_table};
use covmap_model::SensorModel;

/// Draws the figure for one or more models, each with its name.
pub(crate) fn write(output: &FigureFolder, models: &[(&str, &SensorModel)]) -> Result<()> {
    for (name, model) in models {
        output.write(&format!("figure3-{name}.csv"), echo_table(model, RANGE).0)?;
    }
    let panels: Vec<HeatMap> = models.iter().map(|(name, model)| panel(name, model)).collect();
    // All panels share one scale, up to the largest value.
    let values = panels.iter().flat_map(|panel| &panel.values).filter(|value| value.is_finite());
    let largest = values.fold(0.0, |a: f64, b| a.max(*b));
    let scaled = |mut panel: HeatMap| {
        panel.value.to = Some(largest);
        panel.into()
    };
    let figure = Figure {
        title: format!("Fig. 3: the sensor model at a measured distance d = {RANGE} m"),
        subtitle: "probability of each coverage of a cell, over its distance from the sensor"
            .into(),
        panels: panels.into_iter().map(scaled).collect(),
        columns: 2,
    };
    Ok(output.figure("figure3", &figure)?)
}

fn panel(name: &str, model: &SensorModel) -> HeatMap {
    let distances = echo_distances(model, RANGE);
    let bins = model.parameters().bins;
    let columns: Vec<Vec<f64>> = distances.iter().map(|d| column(model, *d)).collect();
    let coverages: Vec<f64> = (0..bins).map(|bin| bin_coverage(bin, bins)).collect();
    let row = |bin: usize| columns.iter().map(move |column| column[bin]);
    HeatMap {
        title: format!("{name}.ron"),
        subtitle: String::new(),
        x: ChartAxis::new("distance of the cell [m]"),
        y: ChartAxis::new("coverage x"),
        value: ChartAxis { from: Some(0.0), ..ChartAxis::new("p(c = x | d)") },
        x_edges: HeatMap::edges(&distances),
        y_edges: HeatMap::edges(&coverages),
        values: (0..bins).flat_map(row).collect(),
        color_map: ColorMap::Viridis,
    }
}
