//! The truth: simulated worlds, their sonar echoes, driving in them, and the exact coverage of every cell
