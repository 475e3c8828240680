//! Converts the solid area around and inside the outlines into convex pieces.
//!
//! Builds a constrained Delaunay triangulation of the outlines. Solid triangles are then merged across edges that are
//! not part of an outline, provided that the result is convex (Hertel and Mehlhorn). All corners are lattice points, so
//! all tests are exact.

use crate::{
    contour::{Component, Node},
    simplify::{Simplified, cross, without_collinear},
};
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};
use std::collections::HashMap;

/// The largest number of corners of a piece.
const MOST_CORNERS: usize = 64;

/// Convex counter-clockwise polygons that together exactly cover the solid part of a component's box.
pub(crate) fn pieces(component: &Component, outlines: &Simplified) -> Vec<Vec<Node>> {
    let ([west, south], [east, north]) = (component.low, component.high);
    let frame = vec![[west, south], [east, south], [east, north], [west, north]];
    let rings: Vec<&Vec<Node>> = outlines.rings.iter().chain([&frame]).collect();
    let mut nodes: Vec<Node> = rings.iter().copied().flatten().copied().collect();
    nodes.sort_unstable();
    nodes.dedup();
    let points = nodes.iter().map(|node| Point2::new(f64::from(node[0]), f64::from(node[1]))).collect();
    let mut mesh = ConstrainedDelaunayTriangulation::<Point2<f64>>::bulk_load_cdt(points, Vec::new())
        .expect("lattice points are finite and distinct");
    let vertices: Vec<_> = mesh.vertices().map(|vertex| vertex.fix()).collect();
    let vertex = |node: &Node| vertices[nodes.binary_search(node).expect("every corner is in the list")];
    for ring in rings {
        for (from, to) in ring.iter().zip(ring.iter().cycle().skip(1)) {
            mesh.add_constraint(vertex(from), vertex(to));
        }
    }
    let node_of = |at: Point2<f64>| [at.x as i32, at.y as i32];
    let solid: Vec<Vec<Node>> = mesh
        .inner_faces()
        .map(|face| face.positions())
        .filter(|[a, b, c]| !outlines.is_free(component, (a.x + b.x + c.x) / 3.0, (a.y + b.y + c.y) / 3.0))
        .map(|corners| corners.map(node_of).to_vec())
        .collect();
    let mut joined = Joined::new(solid);
    let mut inner: Vec<[Node; 2]> = mesh
        .undirected_edges()
        .filter(|edge| !edge.is_constraint_edge())
        .map(|edge| edge.positions().map(node_of))
        .collect();
    // Short edges between pieces are the least useful and are removed first; ties are broken by position.
    inner.sort_unstable_by_key(|[a, b]| ((b[0] - a[0]).pow(2) + (b[1] - a[1]).pow(2), *a, *b));
    for [a, b] in inner {
        joined.join(a, b);
    }
    joined.polygons.into_iter().flatten().map(|ring| without_collinear(&ring)).collect()
}

/// Polygons, and which polygon has which edge.
struct Joined {
    polygons: Vec<Option<Vec<Node>>>,
    by_edge: HashMap<[Node; 2], usize>,
}

impl Joined {
    fn new(polygons: Vec<Vec<Node>>) -> Self {
        let edges = |(index, ring): (usize, &Vec<Node>)| {
            let ring = ring.clone();
            (0..ring.len()).map(move |k| ([ring[k], ring[(k + 1) % ring.len()]], index))
        };
        let by_edge = polygons.iter().enumerate().flat_map(edges).collect();
        Self { polygons: polygons.into_iter().map(Some).collect(), by_edge }
    }

    /// Merges the polygons on both sides of an edge, if both are solid and the result is convex.
    fn join(&mut self, a: Node, b: Node) {
        let (Some(left), Some(right)) = (self.by_edge.get(&[a, b]), self.by_edge.get(&[b, a])) else {
            return;
        };
        let (left, right) = (*left, *right);
        let [Some(one), Some(other)] = [&self.polygons[left], &self.polygons[right]] else { return };
        if left == right || one.len() + other.len() > MOST_CORNERS + 2 {
            return;
        }
        // From b around the left polygon to a, then around the right polygon back to b.
        let mut ring = from(one, b);
        ring.extend(&from(other, a)[1..other.len() - 1]);
        let n = ring.len();
        let is_convex = |k: usize| cross(ring[(k + n - 1) % n], ring[k], ring[(k + 1) % n]) >= 0;
        if !is_convex(0) || !is_convex(one.len() - 1) {
            return;
        }
        self.by_edge.remove(&[a, b]);
        self.by_edge.remove(&[b, a]);
        for k in 0..other.len() {
            if let Some(owner) = self.by_edge.get_mut(&[other[k], other[(k + 1) % other.len()]]) {
                *owner = left;
            }
        }
        self.polygons[right] = None;
        self.polygons[left] = Some(ring);
    }
}

/// The ring, rotated to begin at one of its corners.
fn from(ring: &[Node], first: Node) -> Vec<Node> {
    let at = ring.iter().position(|node| *node == first).expect("the edge is part of the ring");
    ring[at..].iter().chain(&ring[..at]).copied().collect()
}
