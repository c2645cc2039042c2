//! The one program of covmap.
fn main() {}
