//! The part of OBJ that reference cases use: v, vt and f.

use glam::DVec2;

use crate::{Attribute, AttributeValues, Domain, Mesh};

/// Reads a mesh; texture coordinates become corner attribute "uv".
pub(super) fn parse(text: &str) -> Mesh {
    let (mut places, mut uvs) = (Vec::new(), Vec::new());
    let (mut faces, mut corner_uvs) = (Vec::<Vec<u32>>::new(), Vec::new());
    for line in text.lines() {
        let mut words = line.split_whitespace();
        let keyword = words.next();
        let mut number = || words.next().unwrap().parse::<f64>().unwrap();
        match keyword {
            Some("v") => {
                places.push(std::array::from_fn(|_| number()));
            }
            Some("vt") => {
                uvs.push(DVec2::from_array(std::array::from_fn(|_| number())));
            }
            Some("f") => {
                let mut face = Vec::new();
                for word in words {
                    let mut indices = word.split('/').map(|i| i.parse::<usize>().unwrap() - 1);
                    face.push(indices.next().unwrap() as u32);
                    corner_uvs.extend(indices.next().map(|i| uvs[i]));
                }
                faces.push(face);
            }
            _ => {}
        }
    }
    let mesh = Mesh::from_faces(places, &faces).unwrap();
    if corner_uvs.is_empty() {
        return mesh;
    }
    let values = AttributeValues::Vector2(corner_uvs.into());
    mesh.with_attribute(Attribute::new("uv", Domain::Corner, values))
        .unwrap()
}
