//! Grids.

use super::{Header, Pose, RosMessage, Stamp};
use crate::{CdrError, CdrReader, CdrWriter};

/// `nav_msgs/msg/MapMetaData`: the place of a grid.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MapMetaData {
    /// When the map was made.
    pub map_load_time: Stamp,
    /// The side of a cell \[m\].
    pub resolution: f32,
    /// The number of columns.
    pub width: u32,
    /// The number of rows.
    pub height: u32,
    /// The lower left corner of cell (0, 0).
    pub origin: Pose,
}

/// `nav_msgs/msg/OccupancyGrid`: a number from 0 to 100 for each cell, row by row from the lowest; −1 if
/// it is not known.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct OccupancyGrid {
    /// Time and frame.
    pub header: Header,
    /// The place of the grid.
    pub info: MapMetaData,
    /// The cells.
    pub data: Vec<i8>,
}

impl RosMessage for OccupancyGrid {
    const TYPE: &'static str = "nav_msgs/msg/OccupancyGrid";

    fn read(reader: &mut CdrReader<'_>) -> Result<Self, CdrError> {
        let header = Header::read(reader)?;
        let (sec, nanosec) = (reader.i32("map_load_time")?, reader.u32("map_load_time")?);
        let info = MapMetaData {
            map_load_time: Stamp { sec, nanosec },
            resolution: reader.f32("resolution")?,
            width: reader.u32("width")?,
            height: reader.u32("height")?,
            origin: Pose::read(reader)?,
        };
        Ok(Self { header, info, data: reader.list("data", 1, |r| r.i8("data"))? })
    }

    fn write(&self, writer: &mut CdrWriter) {
        self.header.write(writer);
        writer.i32(self.info.map_load_time.sec);
        writer.u32(self.info.map_load_time.nanosec);
        writer.f32(self.info.resolution);
        writer.u32(self.info.width);
        writer.u32(self.info.height);
        self.info.origin.write(writer);
        writer.list(&self.data, |w, cell| w.u8(cell.cast_unsigned()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grid_is_read_as_it_is_written() {
        let info = MapMetaData { resolution: 0.1, width: 2, height: 2, ..MapMetaData::default() };
        let grid = OccupancyGrid { info, data: vec![-1, 0, 100, 50], ..OccupancyGrid::default() };
        assert_eq!(OccupancyGrid::from_cdr(&grid.to_cdr()), Ok(grid));
    }
}
