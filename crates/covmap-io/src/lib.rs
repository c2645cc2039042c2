//! Files for covmap: RON, JSON lines, map_server maps, pictures
