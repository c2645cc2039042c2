//! Where to measure next: view-points by closest location and expected information gain
