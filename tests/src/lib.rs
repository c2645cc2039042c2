//! The paper's claims and the whole workflow live in the tests of this package.
