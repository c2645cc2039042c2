//! The definitions of the messages, as bags carry them (`ros2msg`).
//!
//! One table: the fields of each type as ROS 2 Humble defines them, without comments and constants. The
//! definition of a message holds those of all types that it is made of.

/// A type with its fields.
const DEFINITIONS: [(&str, &str); 25] = [
    ("builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"),
    ("builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n"),
    ("std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"),
    ("std_msgs/ColorRGBA", "float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n"),
    ("geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"),
    ("geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"),
    ("geometry_msgs/Quaternion", "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n"),
    ("geometry_msgs/Pose", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"),
    ("geometry_msgs/PoseStamped", "std_msgs/Header header\ngeometry_msgs/Pose pose\n"),
    ("geometry_msgs/PoseWithCovariance", "geometry_msgs/Pose pose\nfloat64[36] covariance\n"),
    ("geometry_msgs/Twist", "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n"),
    ("geometry_msgs/TwistWithCovariance", "geometry_msgs/Twist twist\nfloat64[36] covariance\n"),
    (
        "geometry_msgs/Transform",
        "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n",
    ),
    (
        "geometry_msgs/TransformStamped",
        "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n",
    ),
    ("tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms\n"),
    (
        "nav_msgs/Odometry",
        "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n\
         geometry_msgs/TwistWithCovariance twist\n",
    ),
    ("nav_msgs/Path", "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n"),
    (
        "nav_msgs/MapMetaData",
        "builtin_interfaces/Time map_load_time\nfloat32 resolution\nuint32 width\nuint32 height\n\
         geometry_msgs/Pose origin\n",
    ),
    ("nav_msgs/OccupancyGrid", "std_msgs/Header header\nnav_msgs/MapMetaData info\nint8[] data\n"),
    (
        "sensor_msgs/Range",
        "std_msgs/Header header\nuint8 radiation_type\nfloat32 field_of_view\nfloat32 min_range\n\
         float32 max_range\nfloat32 range\nfloat32 variance\n",
    ),
    (
        "sensor_msgs/LaserScan",
        "std_msgs/Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\n\
         float32 time_increment\nfloat32 scan_time\nfloat32 range_min\nfloat32 range_max\nfloat32[] ranges\n\
         float32[] intensities\n",
    ),
    ("sensor_msgs/CompressedImage", "std_msgs/Header header\nstring format\nuint8[] data\n"),
    ("visualization_msgs/UVCoordinate", "float32 u\nfloat32 v\n"),
    (
        "visualization_msgs/Marker",
        "std_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\ngeometry_msgs/Pose pose\n\
         geometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\nbuiltin_interfaces/Duration lifetime\n\
         bool frame_locked\ngeometry_msgs/Point[] points\nstd_msgs/ColorRGBA[] colors\nstring texture_resource\n\
         sensor_msgs/CompressedImage texture\nvisualization_msgs/UVCoordinate[] uv_coordinates\nstring text\n\
         string mesh_resource\nvisualization_msgs/MeshFile mesh_file\nbool mesh_use_embedded_materials\n",
    ),
    ("visualization_msgs/MarkerArray", "visualization_msgs/Marker[] markers\n"),
];
const MESH_FILE: (&str, &str) = ("visualization_msgs/MeshFile", "string filename\nuint8[] data\n");

/// The line between two definitions.
const RULE: &str =
    "================================================================================\n";

/// Returns the definition of a type such as `sensor_msgs/msg/Range`, with those of all types that it is
/// made of; `None` for a type that covmap does not write.
pub fn definition(type_name: &str) -> Option<String> {
    let name = type_name.replace("/msg/", "/");
    let mut text = fields(&name)?.to_owned();
    let mut names = parts(&name);
    let mut done = 0;
    while done < names.len() {
        for part in parts(names[done]) {
            if !names.contains(&part) {
                names.push(part);
            }
        }
        done += 1;
    }
    for part in names {
        text.push_str(RULE);
        text.push_str(&format!("MSG: {part}\n"));
        text.push_str(fields(part)?);
    }
    Some(text)
}

fn fields(name: &str) -> Option<&'static str> {
    let all = DEFINITIONS.iter().chain([&MESH_FILE]);
    all.into_iter().find(|(known, _)| *known == name).map(|(_, fields)| *fields)
}

/// Returns the types of a type's own fields that have definitions.
fn parts(name: &str) -> Vec<&'static str> {
    let lines = fields(name).unwrap_or_default().lines();
    let of_line = |line: &'static str| line.split([' ', '[']).next().unwrap_or_default();
    let mut parts = Vec::new();
    for part in lines.map(of_line).filter(|part| part.contains('/')) {
        if !parts.contains(&part) {
            parts.push(part);
        }
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_definition_holds_all_its_parts_once() {
        let text = definition("visualization_msgs/msg/MarkerArray").unwrap();
        assert!(text.starts_with("visualization_msgs/Marker[] markers\n===="));
        let named = |part: &str| text.matches(&format!("MSG: {part}\n")).count();
        for part in [
            "visualization_msgs/Marker",
            "visualization_msgs/MeshFile",
            "std_msgs/Header",
            "builtin_interfaces/Time",
            "geometry_msgs/Point",
        ] {
            assert_eq!(named(part), 1, "{part}");
        }
        assert_eq!(definition("std_msgs/msg/String"), None);
    }

    #[test]
    fn every_part_has_its_fields() {
        for (name, _) in DEFINITIONS {
            assert!(definition(name).is_some(), "{name}");
        }
    }
}
