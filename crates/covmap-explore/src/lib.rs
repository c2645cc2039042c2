//! The exploration loop: sense, integrate, choose, drive, until a certificate says that all is explored
