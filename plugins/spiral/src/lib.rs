//! Planners that follow a preset spiral.
#![forbid(unsafe_code)]

pub mod potential;

pub mod escapes;
pub mod rpf;
pub mod spiral_lattice;
pub mod spiral_tangent;

mod band;
mod course;
mod lattice;
mod pursuit;
mod refusal;
mod ring;
mod strip;
mod tangent;
mod walk;
mod way_out;

#[cfg(test)]
mod bench;

planner_api::export_planners!(
    escapes::Vt,
    escapes::Iapf,
    rpf::Rpf,
    spiral_lattice::SpiralLattice,
    spiral_tangent::SpiralTangent
);
