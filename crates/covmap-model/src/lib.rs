//! The sensor model of coverage maps: how a scan changes the belief
