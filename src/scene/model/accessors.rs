//! Whether the parts of a glTF document lie inside one another, and are of the types that a triangle mesh has.

use gltf::json::accessor::{Accessor, ComponentType, Type};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::{Checked, USize64};
use gltf::json::{Index, Root};

use super::MOST_TRIANGLES;

/// Whether the accessors of all positions are there.
pub fn check_positions(root: &Root) -> Result<(), String> {
    for (m, mesh) in root.meshes.iter().enumerate() {
        for (p, primitive) in mesh.primitives.iter().enumerate() {
            let count = root.accessors.len();
            if let Some(index) = attribute(primitive, Semantic::Positions).map(|index| index.value()).filter(|index| *index >= count) {
                return Err(format!("meshes[{m}].primitives[{p}].attributes.POSITION = {index}: there are {count} accessors"));
            }
        }
    }
    Ok(())
}

/// Checks views, accessors and primitives; what is wrong names its place. The indices of the document must be valid.
pub fn check(root: &Root) -> Result<(), String> {
    for (k, view) in root.buffer_views.iter().enumerate() {
        let buffer = root.get(view.buffer).map_or(0, |buffer| buffer.byte_length.0);
        let end = offset(view.byte_offset).checked_add(view.byte_length.0);
        if end.is_none_or(|end| end > buffer) {
            let (at, length) = (offset(view.byte_offset), view.byte_length.0);
            return Err(format!("bufferViews[{k}]: {length} bytes from {at} on do not fit in the {buffer} of its buffer"));
        }
        if let Some(stride) = view.byte_stride.map(|stride| stride.0).filter(|stride| !stride.is_multiple_of(4)) {
            return Err(format!("bufferViews[{k}].byteStride = {stride}, allowed are multiples of 4"));
        }
    }
    for (k, accessor) in root.accessors.iter().enumerate() {
        check_accessor(root, accessor).map_err(|wrong| format!("accessors[{k}]{wrong}"))?;
    }
    for (m, mesh) in root.meshes.iter().enumerate() {
        for (p, primitive) in mesh.primitives.iter().enumerate() {
            if primitive.mode == Checked::Valid(Mode::Triangles) {
                check_primitive(root, primitive).map_err(|wrong| format!("meshes[{m}].primitives[{p}].{wrong}"))?;
            }
        }
    }
    Ok(())
}

/// Triangles of a primitive that has been checked.
pub fn triangles(root: &Root, primitive: &Primitive) -> u64 {
    let corners = primitive.indices.or_else(|| attribute(primitive, Semantic::Positions));
    corners.and_then(|index| root.get(index)).map_or(0, |accessor| accessor.count.0 / 3)
}

/// Vertices of a primitive that has been checked.
pub fn vertices(root: &Root, primitive: &Primitive) -> u64 {
    attribute(primitive, Semantic::Positions).and_then(|index| root.get(index)).map_or(0, |accessor| accessor.count.0)
}

fn offset(bytes: Option<USize64>) -> u64 {
    bytes.unwrap_or_default().0
}

/// Kinds of elements that an accessor may hold.
type Types<'a> = &'a [(Type, ComponentType)];

fn types(accessor: &Accessor) -> Option<(Type, ComponentType)> {
    match (accessor.type_.as_ref(), accessor.component_type.as_ref()) {
        (Checked::Valid(shape), Checked::Valid(component)) => Some((*shape, component.0)),
        _ => None,
    }
}

fn attribute(primitive: &Primitive, semantic: Semantic) -> Option<Index<Accessor>> {
    primitive.attributes.get(&Checked::Valid(semantic)).copied()
}

/// Whether `count` elements of `size` bytes from `start` on lie inside the view.
fn fits(root: &Root, view: Index<gltf::json::buffer::View>, start: u64, count: u64, size: u64) -> Result<(), String> {
    let Some(found) = root.get(view) else { return Err(format!(".bufferView = {} is not there", view.value())) };
    let stride = found.byte_stride.map_or(size, |stride| stride.0 as u64);
    if stride < size {
        return Err(format!(": elements of {size} bytes overlap at the byteStride = {stride} of bufferViews[{}]", view.value()));
    }
    let end = (count - 1).checked_mul(stride).and_then(|last| last.checked_add(size)).and_then(|all| all.checked_add(start));
    if end.is_none_or(|end| end > found.byte_length.0) {
        let (view, length) = (view.value(), found.byte_length.0);
        return Err(format!(": {count} elements of {size} bytes from {start} on do not fit in the {length} of bufferViews[{view}]"));
    }
    Ok(())
}

fn check_accessor(root: &Root, accessor: &Accessor) -> Result<(), String> {
    let Some((shape, component)) = types(accessor) else { return Err(" is of no known type".into()) };
    let size = (shape.multiplicity() * component.size()) as u64;
    let count = accessor.count.0;
    if count == 0 {
        return Err(".count = 0, allowed 1 or more".into());
    }
    if let Some(view) = accessor.buffer_view {
        fits(root, view, offset(accessor.byte_offset), count, size)?;
    }
    if let Some(sparse) = &accessor.sparse {
        let some = sparse.count.0;
        if !(1..=count).contains(&some) {
            return Err(format!(".sparse.count = {some}, allowed 1 to {count}"));
        }
        let Checked::Valid(index) = sparse.indices.component_type.as_ref() else { return Err(".sparse is of no known type".into()) };
        let parts = [
            ("indices", sparse.indices.buffer_view, sparse.indices.byte_offset, index.0.size() as u64),
            ("values", sparse.values.buffer_view, sparse.values.byte_offset, size),
        ];
        for (name, view, start, size) in parts {
            fits(root, view, start.0, some, size).map_err(|wrong| format!(".sparse.{name}{wrong}"))?;
        }
    }
    Ok(())
}

fn check_primitive(root: &Root, primitive: &Primitive) -> Result<(), String> {
    use ComponentType::{F32, U8, U16, U32};
    let is = |index: Index<Accessor>, name: &str, allowed: Types<'_>, words: &str| match root.get(index) {
        Some(accessor) if types(accessor).is_some_and(|found| allowed.contains(&found)) => Ok(accessor),
        _ => Err(format!("{name} = {}: the accessor must hold {words}", index.value())),
    };
    let Some(index) = attribute(primitive, Semantic::Positions) else { return Err("attributes.POSITION is missing".into()) };
    let positions = is(index, "attributes.POSITION", &[(Type::Vec3, F32)], "three floats (VEC3, 5126)")?.count.0;
    if positions > 3 * MOST_TRIANGLES as u64 {
        return Err(format!("attributes.POSITION: {positions} vertices, allowed {}", 3 * MOST_TRIANGLES));
    }
    let others: [(Semantic, &str, Types, &str); 2] = [
        (Semantic::Normals, "attributes.NORMAL", &[(Type::Vec3, F32)], "three floats (VEC3, 5126)"),
        (
            Semantic::TexCoords(0),
            "attributes.TEXCOORD_0",
            &[(Type::Vec2, F32), (Type::Vec2, U8), (Type::Vec2, U16)],
            "two floats or unsigned bytes or shorts (VEC2, 5126, 5121 or 5123)",
        ),
    ];
    for (semantic, name, allowed, words) in others {
        let Some(index) = attribute(primitive, semantic) else { continue };
        let count = is(index, name, allowed, words)?.count.0;
        if count != positions {
            return Err(format!("{name}: {count} elements, must be as many as positions, {positions}"));
        }
    }
    let corners = match primitive.indices {
        Some(index) => {
            let allowed = [(Type::Scalar, U8), (Type::Scalar, U16), (Type::Scalar, U32)];
            is(index, "indices", &allowed, "unsigned whole numbers (SCALAR, 5121, 5123 or 5125)")?.count.0
        }
        None => positions,
    };
    if !corners.is_multiple_of(3) {
        return Err(format!("indices: {corners} corners of triangles, must be a multiple of 3"));
    }
    if corners / 3 > MOST_TRIANGLES as u64 {
        return Err(format!("indices: {} triangles, allowed {MOST_TRIANGLES}", corners / 3));
    }
    Ok(())
}
