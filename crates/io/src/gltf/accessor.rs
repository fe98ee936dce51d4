//! Accessors: typed elements in buffers, checked before they are read.

use gltf::json::Accessor;
use gltf::json::accessor::{ComponentType, Type};
use gltf::json::validation::Checked;

use super::buffers::{Buffers, Data};
use super::document::Document;
use super::{Budget, EXPORT, fault};
use crate::error::{FaultKind, IoError};

/// Reads accessors.
pub(super) struct Accessors<'a, 'r> {
    document: &'a Document<'a>,
    buffers: Buffers<'a, 'r>,
    pub(super) budget: Budget,
}

/// What an accessor's elements look like.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Layout {
    pub(super) count: usize,
    pub(super) component: ComponentType,
    /// Components per element.
    pub(super) width: usize,
    pub(super) normalized: bool,
}

impl Layout {
    fn element_size(self) -> usize {
        self.width * self.component.size()
    }
}

/// Bytes in which elements lie, `stride` apart.
struct Run<'a> {
    data: Data<'a>,
    start: usize,
    stride: usize,
}

impl<'a, 'r> Accessors<'a, 'r> {
    pub(super) fn new(
        document: &'a Document<'a>,
        buffers: Buffers<'a, 'r>,
        budget: Budget,
    ) -> Self {
        Self {
            document,
            buffers,
            budget,
        }
    }

    /// Whether positions may be small integers.
    pub(super) fn quantized(&self) -> bool {
        self.document.uses("KHR_mesh_quantization")
    }

    /// Count and types of an accessor, which `from` refers to.
    pub(super) fn layout(&self, index: usize, from: &str) -> Result<Layout, IoError> {
        let accessor = self.document.accessors.get(index, from)?;
        let pointer = self.document.accessors.pointer(index);
        let wrong = |field: &str, cause: &str| {
            let pointer = format!("{pointer}/{field}");
            Err(fault(FaultKind::Syntax, &pointer, cause, EXPORT))
        };
        let Checked::Valid(component) = &accessor.component_type else {
            return wrong("componentType", "this component type does not exist");
        };
        let Checked::Valid(kind) = &accessor.type_ else {
            return wrong("type", "this accessor type does not exist");
        };
        let width = match kind {
            Type::Scalar => 1,
            Type::Vec2 => 2,
            Type::Vec3 => 3,
            Type::Vec4 => 4,
            Type::Mat2 | Type::Mat3 | Type::Mat4 => {
                return wrong("type", "a matrix cannot be a vertex attribute or index");
            }
        };
        let count = usize::try_from(accessor.count.0).unwrap_or(usize::MAX);
        if count == 0 {
            return wrong(
                "count",
                "the count is 0; an accessor has at least one element",
            );
        }
        Ok(Layout {
            count,
            component: component.0,
            width,
            normalized: accessor.normalized,
        })
    }

    /// The first `N` components of every element, as numbers; normalised
    /// integers are divided out.
    ///
    /// # Errors
    /// When anything lies outside its buffer, or is NaN or infinite.
    pub(super) fn numbers<const N: usize>(
        &mut self,
        index: usize,
        from: &str,
    ) -> Result<Vec<[f64; N]>, IoError> {
        let layout = self.layout(index, from)?;
        let accessor = self.document.accessors.get(index, from)?;
        let pointer = self.document.accessors.pointer(index);
        let run = self.run(accessor, layout, &pointer)?;
        // With a buffer view the count has been checked against its bytes;
        // without one nothing else bounds it.
        self.budget
            .take((layout.count as u64).saturating_mul(8 * N as u64), &pointer)?;
        let mut out = vec![[0.0; N]; layout.count];
        if let Some(run) = &run {
            convert(run, layout, &mut out);
        }
        if let Some(sparse) = &accessor.sparse {
            let count = usize::try_from(sparse.count.0).unwrap_or(usize::MAX);
            let pointer = format!("{pointer}/sparse");
            if count == 0 || count > layout.count {
                let cause = format!("{count} of {} elements cannot be replaced", layout.count);
                return Err(fault(FaultKind::OutOfRange, &pointer, cause, EXPORT));
            }
            let places = self.sparse_places(sparse, count, layout.count, &pointer)?;
            let values = &sparse.values;
            let view = (values.buffer_view.value(), values.byte_offset.0);
            let some = Layout { count, ..layout };
            let run = self.view_run(view, some, false, &format!("{pointer}/values"))?;
            let mut replaced = vec![[0.0; N]; count];
            convert(&run, some, &mut replaced);
            for (place, value) in places.into_iter().zip(replaced) {
                out[place as usize] = value;
            }
        }
        match out
            .iter()
            .position(|element| element.iter().any(|value| !value.is_finite()))
        {
            None => Ok(out),
            Some(element) => {
                let cause = format!("element {element} is not finite");
                let help = "repair the mesh in the program that made it";
                Err(fault(FaultKind::NotFinite, &pointer, cause, help))
            }
        }
    }

    /// Indices of vertices, of which there are `vertex_count`.
    ///
    /// # Errors
    /// As [`Accessors::numbers`]; when one names no vertex, or is the restart
    /// value, which glTF forbids.
    pub(super) fn indices(
        &mut self,
        index: usize,
        vertex_count: usize,
        from: &str,
    ) -> Result<Vec<u32>, IoError> {
        let layout = self.layout(index, from)?;
        let accessor = self.document.accessors.get(index, from)?;
        let pointer = self.document.accessors.pointer(index);
        let fits = layout.width == 1 && !layout.normalized && is_index(layout.component);
        if !fits {
            let cause = "indices are unsigned integers, SCALAR and not normalized";
            return Err(fault(FaultKind::Syntax, &pointer, cause, EXPORT));
        }
        if accessor.buffer_view.is_none() || accessor.sparse.is_some() {
            let cause = "indices without a buffer view, or sparse ones, are not read";
            return Err(fault(FaultKind::Unsupported, &pointer, cause, EXPORT));
        }
        let Some(run) = self.run(accessor, layout, &pointer)? else {
            return Ok(Vec::new());
        };
        self.budget.take(4 * layout.count as u64, &pointer)?;
        let out = read_indices(&run, layout);
        if let Some(element) = out.iter().position(|&index| index as usize >= vertex_count) {
            let found = out[element];
            let restart = [u8::MAX.into(), u16::MAX.into(), u32::MAX][layout.component.size() / 2];
            let cause = if found == restart {
                format!("index {element} is {found}, the restart value, which glTF forbids")
            } else {
                format!("index {element} names vertex {found}, but there are {vertex_count}")
            };
            return Err(fault(FaultKind::OutOfRange, &pointer, cause, EXPORT));
        }
        Ok(out)
    }

    /// Where an accessor's own elements lie; `None` for zeros.
    fn run(
        &mut self,
        accessor: &Accessor,
        layout: Layout,
        pointer: &str,
    ) -> Result<Option<Run<'a>>, IoError> {
        let offset = accessor.byte_offset.map_or(0, |offset| offset.0);
        match &accessor.buffer_view {
            Some(view) => self
                .view_run((view.value(), offset), layout, true, pointer)
                .map(Some),
            None if accessor.sparse.is_some() => Ok(None),
            None => {
                let cause = "the accessor has no buffer view, so it has no data";
                let help = "if the mesh is compressed, export it without compression";
                Err(fault(FaultKind::Unsupported, pointer, cause, help))
            }
        }
    }

    /// `layout.count` elements at an offset into a buffer view, every one of
    /// them inside the view, and the view inside its buffer.
    fn view_run(
        &mut self,
        (view, offset): (usize, u64),
        layout: Layout,
        strided: bool,
        pointer: &str,
    ) -> Result<Run<'a>, IoError> {
        let index = view;
        let view = self
            .document
            .views
            .get(index, &format!("{pointer}/bufferView"))?;
        let view_pointer = self.document.views.pointer(index);
        let compressed = view
            .extensions
            .as_ref()
            .map(|extensions| &extensions.others);
        let compressed =
            compressed.and_then(|others| others.keys().find(|name| name.contains("meshopt")));
        let buffer = view.buffer.value();
        let data = self
            .buffers
            .get(buffer, &format!("{view_pointer}/buffer"))
            .map_err(|error| match (compressed, error) {
                (Some(name), IoError::Fault(mut fault)) => {
                    fault.cause = format!("the data is compressed with {name}, which is not read");
                    fault.help = "export without compression".to_owned();
                    IoError::Fault(fault)
                }
                (_, error) => error,
            })?;
        let size = layout.element_size() as u64;
        let stride = match view.byte_stride {
            Some(stride) if strided && stride.0 != 0 => stride.0 as u64,
            _ => size,
        };
        if stride < size || stride > 252 {
            let cause = format!("elements of {size} bytes cannot be {stride} bytes apart");
            let pointer = format!("{view_pointer}/byteStride");
            return Err(fault(FaultKind::OutOfRange, &pointer, cause, EXPORT));
        }
        let start = view.byte_offset.map_or(0, |offset| offset.0);
        let length = self.document.buffers.get(buffer, pointer)?.byte_length.0;
        if start
            .checked_add(view.byte_length.0)
            .is_none_or(|end| end > length)
        {
            let cause = format!(
                "the view of {} bytes from byte {start} lies outside its buffer of {length}",
                view.byte_length.0
            );
            return Err(fault(FaultKind::OutOfRange, &view_pointer, cause, EXPORT));
        }
        let last = (layout.count as u64 - 1).checked_mul(stride);
        let end = last.and_then(|last| last.checked_add(offset)?.checked_add(size));
        if end.is_none_or(|end| end > view.byte_length.0) {
            let cause = format!(
                "{} elements of {size} bytes, {stride} apart, from byte {offset} lie outside the view of {}",
                layout.count, view.byte_length.0
            );
            return Err(fault(FaultKind::OutOfRange, pointer, cause, EXPORT));
        }
        // Both fit, as the buffer they lie in does.
        Ok(Run {
            data,
            start: (start + offset) as usize,
            stride: stride as usize,
        })
    }

    /// The elements that a sparse accessor replaces, ascending.
    fn sparse_places(
        &mut self,
        sparse: &gltf::json::accessor::sparse::Sparse,
        count: usize,
        elements: usize,
        pointer: &str,
    ) -> Result<Vec<u32>, IoError> {
        let pointer = format!("{pointer}/indices");
        let indices = &sparse.indices;
        let Checked::Valid(component) = &indices.component_type else {
            let cause = "this component type is not one of unsigned integers";
            return Err(fault(FaultKind::Syntax, &pointer, cause, EXPORT));
        };
        let layout = Layout {
            count,
            component: component.0,
            width: 1,
            normalized: false,
        };
        let view = (indices.buffer_view.value(), indices.byte_offset.0);
        let run = self.view_run(view, layout, false, &pointer)?;
        let places = read_indices(&run, layout);
        let ascending = places.windows(2).all(|pair| pair[0] < pair[1]);
        if !ascending || places.last().is_some_and(|&last| last as usize >= elements) {
            let cause = format!("the places do not ascend, or go beyond the {elements} elements");
            return Err(fault(FaultKind::OutOfRange, &pointer, cause, EXPORT));
        }
        Ok(places)
    }
}

fn is_index(component: ComponentType) -> bool {
    matches!(
        component,
        ComponentType::U8 | ComponentType::U16 | ComponentType::U32
    )
}

/// Unsigned integers; the run was checked.
fn read_indices(run: &Run<'_>, layout: Layout) -> Vec<u32> {
    let bytes = &run.data.bytes()[run.start..];
    let elements = bytes.chunks(run.stride).take(layout.count);
    match layout.component.size() {
        1 => elements.map(|element| element[0].into()).collect(),
        2 => elements
            .map(|element| u16::from_le_bytes([element[0], element[1]]).into())
            .collect(),
        _ => elements
            .map(|e| u32::from_le_bytes([e[0], e[1], e[2], e[3]]))
            .collect(),
    }
}

/// Components as numbers; the run was checked.
fn convert<const N: usize>(run: &Run<'_>, layout: Layout, out: &mut [[f64; N]]) {
    fn fill<const N: usize, const S: usize>(
        run: &Run<'_>,
        out: &mut [[f64; N]],
        value: impl Fn([u8; S]) -> f64,
    ) {
        let bytes = &run.data.bytes()[run.start..];
        for (slot, element) in out.iter_mut().zip(bytes.chunks(run.stride)) {
            for (number, component) in slot.iter_mut().zip(element.as_chunks::<S>().0) {
                *number = value(*component);
            }
        }
    }
    let unit = |max: f64| if layout.normalized { max } else { 1.0 };
    // The most negative integer is one step beyond -1.
    let signed = |value: f64, max: f64| {
        (value / unit(max)).max(if layout.normalized { -1.0 } else { value })
    };
    match layout.component {
        ComponentType::I8 => fill(run, out, |[b]| signed(f64::from(b.cast_signed()), 127.0)),
        ComponentType::U8 => fill(run, out, |[b]| f64::from(b) / unit(255.0)),
        ComponentType::I16 => fill(run, out, |b| signed(i16::from_le_bytes(b).into(), 32767.0)),
        ComponentType::U16 => fill(run, out, |b| {
            f64::from(u16::from_le_bytes(b)) / unit(65535.0)
        }),
        ComponentType::U32 => fill(run, out, |b| f64::from(u32::from_le_bytes(b))),
        ComponentType::F32 => fill(run, out, |b| f64::from(f32::from_le_bytes(b))),
    }
}
