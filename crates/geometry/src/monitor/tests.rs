//! Long operations stop wherever they are asked to, and are asked often.

use std::sync::atomic::{AtomicUsize, Ordering};

use super::Monitor;
use crate::fields::{Curvature, curvature};
use crate::intersect::intersections;
use crate::normals::{NormalWeights, vertex_normals};
use crate::parallel::{self, CHUNK};
use crate::surface::Surface;
use crate::test_support::grid;
use crate::{GeometryError, Mesh, Unmonitored, weld_vertices};

/// Asks to stop from the poll after `polls` on.
struct Stopping {
    polls: usize,
    seen: AtomicUsize,
}

impl Stopping {
    fn after(polls: usize) -> Self {
        let seen = AtomicUsize::new(0);
        Self { polls, seen }
    }
}

impl Monitor for Stopping {
    fn cancelled(&self) -> bool {
        self.seen.fetch_add(1, Ordering::Relaxed) >= self.polls
    }
}

/// A saddle of 25 600 corners that knows nothing of its neighbours yet.
fn sheet() -> Mesh {
    grid(80, 80, |x, y| [x, y, 0.01 * x * (y - 40.0)])
}

/// Runs `work` stopped after 0, 1, 2 ... polls, until it is not stopped any more:
/// that is after as many as it takes undisturbed, one for each `per` corners at least.
fn stops_everywhere<T>(per: usize, work: impl Fn(&Mesh, &dyn Monitor) -> Result<T, GeometryError>) {
    let undisturbed = Stopping::after(usize::MAX);
    let mesh = sheet();
    work(&mesh, &undisturbed).expect("nobody stops it");
    let polls = undisturbed.seen.into_inner();
    let least = mesh.corner_count() / per;
    assert!(polls >= least, "{polls} polls, not {least}");
    for after in 0..=polls {
        let stopped = work(&sheet(), &Stopping::after(after));
        let is_stopped = matches!(stopped, Err(GeometryError::Cancelled));
        assert_eq!(is_stopped, after < polls, "after {after} of {polls} polls");
    }
}

#[test]
fn building_neighbours_stops() {
    stops_everywhere(CHUNK / 8, |mesh, monitor| {
        mesh.topology().adjacency_with(monitor).map(|_| ())
    });
}

#[test]
fn a_stopped_build_leaves_the_neighbours_to_the_next() {
    let (stopped, whole) = (sheet(), sheet());
    for after in 0..20 {
        let monitor = Stopping::after(after);
        assert!(stopped.topology().adjacency_with(&monitor).is_err());
    }
    let [a, b] = [&stopped, &whole].map(|mesh| mesh.topology().adjacency());
    assert_eq!(a.edges(), b.edges());
    assert_eq!(a.corner_edges(), b.corner_edges());
    for vertex in 0..whole.vertex_count() {
        assert_eq!(a.vertex_edges(vertex), b.vertex_edges(vertex));
    }
}

#[test]
fn triangulation_stops() {
    stops_everywhere(4 * CHUNK, |mesh, monitor| mesh.triangles_with(monitor));
}

#[test]
fn vertex_normals_stop() {
    stops_everywhere(CHUNK / 8, |mesh, monitor| {
        vertex_normals(mesh, NormalWeights::Angle, true, monitor)
    });
}

#[test]
fn welding_stops() {
    for distance in [0.0, 1e-6] {
        stops_everywhere(CHUNK, |mesh, monitor| {
            weld_vertices(mesh, distance, monitor)
        });
    }
}

#[test]
fn sorting_a_surface_stops() {
    stops_everywhere(CHUNK / 8, Surface::new);
}

#[test]
fn finding_intersections_stops() {
    stops_everywhere(CHUNK, |mesh, monitor| {
        intersections(mesh, &Default::default(), monitor)
    });
}

#[test]
fn curvature_stops() {
    stops_everywhere(CHUNK / 8, |mesh, monitor| {
        curvature(mesh, Curvature::Mean, monitor)
    });
}

#[test]
fn sorting_is_stable_at_any_length() {
    for count in [
        0,
        1,
        CHUNK - 1,
        CHUNK,
        CHUNK + 1,
        2 * CHUNK + 1,
        7 * CHUNK + 5,
    ] {
        // Few keys, so that most items have equals far away.
        let mut items: Vec<(usize, usize)> = (0..count).map(|k| (k * 7919 % 101, k)).collect();
        let mut expected = items.clone();
        expected.sort_by_key(|&(key, _)| key);
        parallel::sort_by_key(&mut items, &Unmonitored, |&(key, _)| key).expect("nobody stops it");
        assert_eq!(items, expected, "{count} items");
    }
}
