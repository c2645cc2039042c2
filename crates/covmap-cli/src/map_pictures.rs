//! The pictures of a log's map.

use crate::map_summary::MapSummary;
use covmap::CoverageMap;
use covmap_draw::Picture;
use covmap_lab::{
    Mapper,
    results::{draw_coverage, draw_entropy, draw_occupancy, draw_path},
};
use nalgebra::Point2;

/// The content of the pictures.
pub(crate) struct MapPictures<'a> {
    pub(crate) mapper: &'a Mapper,
    /// The map, after the read-out.
    pub(crate) map: &'a CoverageMap,
    /// The description of the read-out; may be empty.
    pub(crate) how: &'a str,
    pub(crate) summary: &'a MapSummary,
    /// ε: a cell with an entropy up to this does not fade \[nats\].
    pub(crate) explored: f64,
}

impl MapPictures<'_> {
    fn begin(&self, what: &str) -> Picture {
        let MapSummary { world, sensor, resolution, scans, path_length_m, .. } = self.summary;
        let mut picture = Picture::new(*self.mapper.map.grid());
        picture
            .title(&format!("{world}: {what}"))
            .subtitle(&format!(
                "{sensor}, r = {resolution} m: {scans} scans, {path_length_m:.1} m driven"
            ))
            .scale_bar();
        picture
    }

    fn path(&self, picture: &mut Picture) {
        if let (Some(first), Some(last)) = (self.mapper.first, self.mapper.last) {
            let start = Point2::from(first.translation.vector);
            let end = Point2::from(last.translation.vector);
            let line = self.mapper.trail.line();
            draw_path(picture, &line, start, (end, last.rotation.angle()));
        }
    }

    pub(crate) fn coverage(&self) -> Picture {
        let mut picture = self.begin(&format!("most likely coverage{}", self.how));
        draw_coverage(&mut picture, self.map, self.explored);
        self.path(&mut picture);
        picture
    }

    pub(crate) fn entropy(&self) -> Picture {
        let mut picture = self.begin(&format!("entropy of the coverage{}", self.how));
        draw_entropy(&mut picture, self.map);
        picture
    }

    pub(crate) fn occupancy(&self) -> Picture {
        let mut picture = self.begin("log-odds occupancy grid of the same scans");
        draw_occupancy(&mut picture, &self.mapper.occupancy);
        self.path(&mut picture);
        picture
    }
}
