//! Places and motions.

use super::{Header, RosMessage, frame};
use crate::{CdrError, CdrReader, CdrWriter};

/// `geometry_msgs/msg/Transform` and `geometry_msgs/msg/Pose`, which have the same fields.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transform {
    /// x, y and z \[m\].
    pub translation: [f64; 3],
    /// The quaternion: x, y, z and w.
    pub rotation: [f64; 4],
}

/// `geometry_msgs/msg/Pose`.
pub type Pose = Transform;

impl Default for Transform {
    fn default() -> Self {
        Self { translation: [0.0; 3], rotation: [0.0, 0.0, 0.0, 1.0] }
    }
}

impl Transform {
    pub(crate) fn read(reader: &mut CdrReader<'_>) -> Result<Self, CdrError> {
        let mut read = |field: &'static str| reader.f64(field);
        let translation = [read("position.x")?, read("position.y")?, read("position.z")?];
        let [x, y] = [read("orientation.x")?, read("orientation.y")?];
        let rotation = [x, y, read("orientation.z")?, read("orientation.w")?];
        Ok(Self { translation, rotation })
    }

    pub(crate) fn write(&self, writer: &mut CdrWriter) {
        writer.f64s(&self.translation);
        writer.f64s(&self.rotation);
    }
}

/// `geometry_msgs/msg/TransformStamped`: the place of a child frame in the header's frame.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TransformStamped {
    /// Time, and the parent frame.
    pub header: Header,
    /// The child frame.
    pub child_frame_id: String,
    /// `parent_from_child`.
    pub transform: Transform,
}

impl TransformStamped {
    fn read(reader: &mut CdrReader<'_>) -> Result<Self, CdrError> {
        Ok(Self {
            header: Header::read(reader)?,
            child_frame_id: frame(&reader.string("child_frame_id")?),
            transform: Transform::read(reader)?,
        })
    }

    fn write(&self, writer: &mut CdrWriter) {
        self.header.write(writer);
        writer.string(&self.child_frame_id);
        self.transform.write(writer);
    }
}

/// `tf2_msgs/msg/TFMessage`: transforms.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TfMessage {
    /// The transforms.
    pub transforms: Vec<TransformStamped>,
}

impl RosMessage for TfMessage {
    const TYPE: &'static str = "tf2_msgs/msg/TFMessage";

    fn read(reader: &mut CdrReader<'_>) -> Result<Self, CdrError> {
        Ok(Self { transforms: reader.list("transforms", 72, TransformStamped::read)? })
    }

    fn write(&self, writer: &mut CdrWriter) {
        writer.list(&self.transforms, |w, transform| transform.write(w));
    }
}

/// `nav_msgs/msg/Odometry`: the place and the speed of a robot by its wheels.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Odometry {
    /// Time, and the frame of the pose.
    pub header: Header,
    /// The frame of the robot.
    pub child_frame_id: String,
    /// `odom_from_robot`.
    pub pose: Pose,
    /// Speeds along x, y and z \[m/s\] and around them \[rad/s\].
    pub twist: [f64; 6],
}

/// The number of elements of a covariance of a pose.
const COVARIANCE: usize = 36;

impl RosMessage for Odometry {
    const TYPE: &'static str = "nav_msgs/msg/Odometry";

    fn read(reader: &mut CdrReader<'_>) -> Result<Self, CdrError> {
        let header = Header::read(reader)?;
        let child_frame_id = frame(&reader.string("child_frame_id")?);
        let pose = Pose::read(reader)?;
        for _ in 0..COVARIANCE {
            reader.f64("pose.covariance")?;
        }
        let mut twist = [0.0; 6];
        for speed in &mut twist {
            *speed = reader.f64("twist.twist")?;
        }
        Ok(Self { header, child_frame_id, pose, twist })
    }

    fn write(&self, writer: &mut CdrWriter) {
        self.header.write(writer);
        writer.string(&self.child_frame_id);
        self.pose.write(writer);
        writer.f64s(&[0.0; COVARIANCE]);
        writer.f64s(&self.twist);
        writer.f64s(&[0.0; COVARIANCE]);
    }
}

/// `geometry_msgs/msg/PoseStamped`.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PoseStamped {
    /// Time and frame.
    pub header: Header,
    /// The pose.
    pub pose: Pose,
}

impl RosMessage for PoseStamped {
    const TYPE: &'static str = "geometry_msgs/msg/PoseStamped";

    fn read(reader: &mut CdrReader<'_>) -> Result<Self, CdrError> {
        Ok(Self { header: Header::read(reader)?, pose: Pose::read(reader)? })
    }

    fn write(&self, writer: &mut CdrWriter) {
        self.header.write(writer);
        self.pose.write(writer);
    }
}

/// `nav_msgs/msg/Path`: poses in their order.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Path {
    /// Time and frame.
    pub header: Header,
    /// The poses.
    pub poses: Vec<PoseStamped>,
}

impl RosMessage for Path {
    const TYPE: &'static str = "nav_msgs/msg/Path";

    fn read(reader: &mut CdrReader<'_>) -> Result<Self, CdrError> {
        let header = Header::read(reader)?;
        Ok(Self { header, poses: reader.list("poses", 68, PoseStamped::read)? })
    }

    fn write(&self, writer: &mut CdrWriter) {
        self.header.write(writer);
        writer.list(&self.poses, |w, pose| pose.write(w));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_read_as_they_are_written() {
        let transform = TransformStamped {
            header: Header { frame_id: "odom".into(), ..Header::default() },
            child_frame_id: "base_link".into(),
            transform: Transform { translation: [1.0, 2.0, 3.0], rotation: [0.0, 0.0, 0.6, 0.8] },
        };
        let message =
            TfMessage { transforms: vec![transform.clone(), TransformStamped::default()] };
        assert_eq!(TfMessage::from_cdr(&message.to_cdr()), Ok(message));
        let odometry = Odometry {
            header: transform.header.clone(),
            child_frame_id: "base_link".into(),
            pose: transform.transform,
            twist: [0.5, 0.0, 0.0, 0.0, 0.0, 0.1],
        };
        assert_eq!(Odometry::from_cdr(&odometry.to_cdr()), Ok(odometry));
        let pose = PoseStamped { header: transform.header.clone(), pose: transform.transform };
        let path = Path { header: transform.header, poses: vec![pose.clone(), pose] };
        assert_eq!(Path::from_cdr(&path.to_cdr()), Ok(path));
    }

    #[test]
    fn a_frame_of_ros_1_loses_its_slash() {
        let header = Header { frame_id: "/odom".into(), ..Header::default() };
        let pose = PoseStamped { header, ..PoseStamped::default() };
        assert_eq!(PoseStamped::from_cdr(&pose.to_cdr()).unwrap().header.frame_id, "odom");
    }
}
