//! linkwear compiles a linkage into its life.
