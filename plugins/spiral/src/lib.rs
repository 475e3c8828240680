//! Planners for the preset spiral.
#![forbid(unsafe_code)]

mod rpf;
mod spiral_lattice;

mod course;
mod lattice;
mod polish;
mod refusal;
mod strip;

#[cfg(test)]
mod bench;

planner_api::export_planners!(rpf::Rpf, spiral_lattice::SpiralLattice);
