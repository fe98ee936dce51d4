//! Nothing lies on anything else, whatever the graph.

use super::layout::{Layout, Place, width_of};
use super::model::{Edge, Item, Picture, Role};
use super::{dot, mermaid, svg};

/// Numbers that look random.
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, most: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (self.0 >> 33) as usize % most
    }
}

fn item(line: String) -> Item {
    Item {
        role: Role::Mesh,
        lines: vec![line, "Kind".to_owned()],
        tip: String::new(),
        used: true,
    }
}

/// A picture of `count` boxes, each taking from a few before it.
fn random(count: usize, seed: u64) -> Picture {
    let mut numbers = Numbers(seed);
    let boxes = (0..count).map(|_| item("x".repeat(1 + numbers.below(40))));
    let boxes: Vec<Item> = boxes.collect();
    let mut edges = Vec::new();
    for to in 1..count {
        for _ in 0..numbers.below(4) {
            let from = numbers.below(to);
            if !edges
                .iter()
                .any(|edge: &Edge| (edge.from, edge.to) == (from, to))
            {
                let label = String::new();
                edges.push(Edge { from, to, label });
            }
        }
    }
    Picture {
        title: "random".to_owned(),
        boxes,
        edges,
    }
}

fn overlap(one: &Place, other: &Place) -> bool {
    one.x < other.x + other.width
        && other.x < one.x + one.width
        && one.y < other.y + other.height
        && other.y < one.y + one.height
}

#[test]
fn boxes_edges_and_text_keep_apart() {
    for seed in 0..60 {
        let picture = random(2 + seed as usize, seed);
        let layout = Layout::new(&picture).unwrap();
        for (index, place) in layout.places.iter().enumerate() {
            let widest = picture.boxes[index].lines.iter().map(|line| width_of(line));
            assert!(widest.fold(0.0, f64::max) < place.width);
            assert!(place.x >= 0.0 && place.y >= 0.0);
            assert!(
                place.x + place.width <= layout.width && place.y + place.height <= layout.height
            );
            for other in &layout.places[..index] {
                assert!(!overlap(place, other), "{place:?} and {other:?} of {seed}");
            }
        }
        for (edge, way) in picture.edges.iter().zip(&layout.ways) {
            let (from, to) = (layout.places[edge.from], layout.places[edge.to]);
            assert!(way[0][0] >= from.x + from.width && way[way.len() - 1][0] <= to.x);
            // A level piece runs past boxes, not under them.
            for pair in way[1..way.len() - 1].chunks(2) {
                let ([x, y], [right, _]) = (pair[0], pair[1]);
                let piece = Place {
                    x,
                    y,
                    width: right - x,
                    height: 0.0,
                };
                for place in &layout.places {
                    assert!(!overlap(&piece, place), "an edge under a box of {seed}");
                }
            }
            assert!(way.windows(2).all(|pair| pair[0][0] <= pair[1][0]));
        }
    }
}

#[test]
fn whatever_stands_in_names_stays_text() {
    let nasty = "a\"b\\<c>&'#`%;|é☃\u{4e16}";
    let edge = Edge {
        from: 0,
        to: 1,
        label: nasty.to_owned(),
    };
    let picture = Picture {
        title: nasty.to_owned(),
        boxes: vec![item(nasty.to_owned()), item("plain".to_owned())],
        edges: vec![edge],
    };
    let drawn = svg(&picture).unwrap();
    assert!(!drawn.contains("<c>") && drawn.contains("a&quot;b\\&lt;c&gt;&amp;"));
    let text = dot(&picture);
    assert!(
        text.contains(r#"label="a\"b\\<c>&'#`%;|é☃世\nKind""#),
        "{text}"
    );
    let text = mermaid(&picture);
    assert!(
        text.contains("b0[\"a#34;b#92;#60;c#62;#38;'#35;#96;#37;#59;|é☃世<br/>Kind\"]"),
        "{text}"
    );
}

#[test]
fn a_picture_beyond_all_bounds_is_refused_at_once() {
    // A long chain, whose first box every other one takes from.
    let mut picture = random(1, 0);
    picture.boxes = (0..3000).map(|index| item(index.to_string())).collect();
    let edge = |from, to| Edge {
        from,
        to,
        label: String::new(),
    };
    picture.edges = (1..3000)
        .flat_map(|to| [edge(to - 1, to), edge(0, to)])
        .collect();
    picture.edges.dedup();
    assert!(svg(&picture).is_none());
    assert!(dot(&picture).lines().count() > 6000);
}
