//! A symmetric system of equations in which each node couples only with its neighbours, solved directly.

use geometry::Vector;
use nalgebra::Matrix2;

/// The system for the changes of the nodes between two ends that stay.
pub(crate) struct System {
    nodes: usize,
    force: Vec<Vector>,
    own: Vec<Matrix2<f64>>,
    /// Coupling of each node with the next.
    next: Vec<Matrix2<f64>>,
    /// The changes, after a call to [`System::solve`].
    pub solution: Vec<Vector>,
}

impl System {
    pub(crate) fn new(nodes: usize) -> Self {
        Self {
            nodes,
            force: Vec::with_capacity(nodes),
            own: Vec::with_capacity(nodes),
            next: vec![Matrix2::zeros(); nodes],
            solution: vec![Vector::zeros(); nodes],
        }
    }

    pub(crate) fn clear(&mut self) {
        self.force.clear();
        self.own.clear();
        self.next.fill(Matrix2::zeros());
    }

    /// Adds the next node, with the force on it and its own stiffness.
    pub(crate) fn push(&mut self, force: Vector, stiffness: Matrix2<f64>) {
        self.force.push(force);
        self.own.push(stiffness);
    }

    /// Adds a link that pulls its two nodes together; link 0 leads from the first end to the first node.
    pub(crate) fn couple(&mut self, link: usize, pull: Vector, stiffness: Matrix2<f64>) {
        if let Some(near) = link.checked_sub(1).filter(|near| *near < self.nodes) {
            self.force[near] += pull;
            self.own[near] += stiffness;
            if link < self.nodes {
                self.next[near] = -stiffness;
            }
        }
        if link < self.nodes {
            self.force[link] -= pull;
            self.own[link] += stiffness;
        }
    }

    /// Solves the system by elimination; a node whose own stiffness has no inverse stays.
    pub(crate) fn solve(&mut self) {
        for node in 0..self.nodes {
            let inverse = self.own[node].try_inverse().unwrap_or_else(Matrix2::zeros);
            self.own[node] = inverse;
            if node + 1 < self.nodes {
                // The matrices are symmetric, their product with an inverse is not.
                let by = self.next[node].transpose() * inverse;
                let (less, force) = (by * self.next[node], by * self.force[node]);
                self.own[node + 1] -= less;
                self.force[node + 1] -= force;
            }
        }
        for node in (0..self.nodes).rev() {
            let after = if node + 1 < self.nodes { self.solution[node + 1] } else { Vector::zeros() };
            self.solution[node] = self.own[node] * (self.force[node] - self.next[node] * after);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_solution_balances_every_node() {
        let mut system = System::new(3);
        let skew = Matrix2::new(2.0, 0.5, 0.5, 1.0);
        let forces = [Vector::new(1.0, -2.0), Vector::new(0.3, 0.0), Vector::new(-4.0, 1.0)];
        for force in forces {
            system.push(force, Matrix2::identity() * 0.1);
        }
        for link in 0..4 {
            system.couple(link, Vector::zeros(), skew * (link as f64 + 1.0));
        }
        system.solve();
        let at =
            |node: usize| if (1..=3).contains(&node) { system.solution[node - 1] } else { Vector::zeros() };
        for node in 1..=3 {
            let from_links = skew
                * ((at(node - 1) - at(node)) * node as f64 + (at(node + 1) - at(node)) * (node as f64 + 1.0));
            assert!((forces[node - 1] + from_links - at(node) * 0.1).norm() < 1e-12);
        }
    }
}
