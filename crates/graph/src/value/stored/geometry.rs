//! Meshes, directions and fields in the cache.

use std::sync::Arc;

use glam::DVec3;
use tessgraph_geometry::{
    Attribute, AttributeValues, DirectionSource, Directions, Domain, Field, Labels, Material, Mesh,
};

use super::{Stored, quantity_of, quantity_tag};
use crate::value::encode::{Decoder, Encoder};

impl Stored for Arc<Mesh> {
    fn encode(&self, out: &mut Encoder) -> bool {
        out.topology(self.topology()).array(self.positions());
        out.number(self.attributes().len() as u64);
        for attribute in self.attributes() {
            encode_attribute(attribute, out);
        }
        encode_labels(self.materials(), out, |material, out| {
            out.text(&material.name);
            let numbers = material.base_color.iter();
            for number in numbers.chain([&material.metallic, &material.roughness]) {
                out.float(*number);
            }
        });
        encode_labels(self.groups(), out, |names, out| {
            out.number(names.len() as u64);
            names.iter().for_each(|name| {
                out.text(name);
            });
        });
        encode_labels(self.objects(), out, |name, out| {
            out.text(name);
        });
        true
    }

    fn decode(from: &mut Decoder<'_>) -> Option<Self> {
        let topology = from.topology()?;
        let mut mesh = Mesh::new(from.array()?, topology).ok()?;
        for _ in 0..from.count()? {
            mesh = mesh.with_attribute(decode_attribute(from)?).ok()?;
        }
        let materials = decode_labels(from, |from| {
            Some(Material {
                name: from.text()?.to_owned(),
                base_color: [from.float()?, from.float()?, from.float()?, from.float()?],
                metallic: from.float()?,
                roughness: from.float()?,
            })
        })?;
        let text = |from: &mut Decoder<'_>| from.text().map(str::to_owned);
        let groups = decode_labels(from, |from| {
            let count = from.count()?;
            (0..count).map(|_| text(from)).collect()
        })?;
        let objects = decode_labels(from, text)?;
        let mesh = mesh.with_materials(materials).ok()?;
        let mesh = mesh.with_groups(groups).ok()?.with_objects(objects).ok()?;
        Some(Self::new(mesh))
    }
}

fn encode_attribute(attribute: &Attribute, out: &mut Encoder) {
    out.text(attribute.name());
    out.byte(domain_tag(attribute.domain()));
    match attribute.values() {
        AttributeValues::Integer(values) => out.byte(0).array::<i64>(values),
        AttributeValues::Number(values) => out.byte(1).array::<f64>(values),
        AttributeValues::Vector2(values) => out.byte(2).array(values),
        AttributeValues::Vector3(values) => out.byte(3).array::<DVec3>(values),
    };
}

fn decode_attribute(from: &mut Decoder<'_>) -> Option<Attribute> {
    let name = from.text()?.to_owned();
    let domain = domain_of(from.byte()?)?;
    let values = match from.byte()? {
        0 => AttributeValues::Integer(from.array()?.into()),
        1 => AttributeValues::Number(from.array()?.into()),
        2 => AttributeValues::Vector2(from.array()?.into()),
        3 => AttributeValues::Vector3(from.array()?.into()),
        _ => return None,
    };
    Some(Attribute::new(name, domain, values))
}

fn encode_labels<L>(labels: &Labels<L>, out: &mut Encoder, encode: impl Fn(&L, &mut Encoder)) {
    out.number(labels.labels().len() as u64);
    labels.labels().iter().for_each(|label| encode(label, out));
    out.array::<u32>(labels.of_face());
}

fn decode_labels<L>(
    from: &mut Decoder<'_>,
    decode: impl Fn(&mut Decoder<'_>) -> Option<L>,
) -> Option<Labels<L>> {
    let count = from.count()?;
    let labels: Option<Vec<L>> = (0..count).map(|_| decode(from)).collect();
    Labels::new(labels?, from.array()?).ok()
}

impl Stored for Arc<Directions> {
    fn encode(&self, out: &mut Encoder) -> bool {
        out.topology(self.topology());
        out.byte(match self.source() {
            DirectionSource::Surface => 0,
            DirectionSource::Target => 1,
        });
        out.byte(u8::from(self.is_compensated()));
        // One buffer on both sides stays one buffer.
        let shared = self.outward().is_same(self.inward());
        out.byte(u8::from(shared)).array::<DVec3>(self.outward());
        if !shared {
            out.array::<DVec3>(self.inward());
        }
        true
    }

    fn decode(from: &mut Decoder<'_>) -> Option<Self> {
        let topology = from.topology()?;
        let source = match from.byte()? {
            0 => DirectionSource::Surface,
            1 => DirectionSource::Target,
            _ => return None,
        };
        let (compensated, shared) = (bool::decode(from)?, bool::decode(from)?);
        let outward = from.array()?;
        let inward = if shared { None } else { Some(from.array()?) };
        let directions = Directions::from_parts(topology, outward, inward, source, compensated);
        directions.ok().map(Self::new)
    }
}

impl Stored for Arc<Field> {
    fn encode(&self, out: &mut Encoder) -> bool {
        out.byte(domain_tag(self.domain()));
        out.byte(quantity_tag(self.quantity()));
        out.array::<f64>(self.values());
        true
    }

    fn decode(from: &mut Decoder<'_>) -> Option<Self> {
        let (domain, quantity) = (domain_of(from.byte()?)?, quantity_of(from.byte()?)?);
        Field::new(domain, quantity, from.array()?)
            .ok()
            .map(Self::new)
    }
}

fn domain_tag(domain: Domain) -> u8 {
    match domain {
        Domain::Vertex => 0,
        Domain::Face => 1,
        Domain::Corner => 2,
    }
}

fn domain_of(tag: u8) -> Option<Domain> {
    [Domain::Vertex, Domain::Face, Domain::Corner]
        .get(usize::from(tag))
        .copied()
}
