//! The layout of a struct as a shader has it and as Rust has it.

use wgpu::naga::{ArraySize, Module, Scalar, ScalarKind, StructMember, TypeInner};

/// The name at the end of a path; of a composed name, that without the mark of its module.
fn plain(name: &str) -> &str {
    let name = name.rsplit("::").next().unwrap_or(name);
    name.split("X_naga_oil_mod_X").next().unwrap_or(name)
}

/// A field as both languages can tell it: name, offset and size in bytes, whether it holds floats (of 4 bytes, as all that crosses).
pub type Field = (String, u32, u32, bool);

/// The members of a struct of the shader, and its size in bytes.
pub fn struct_of<'a>(module: &'a Module, name: &str) -> (&'a [StructMember], u32) {
    let found = module.types.iter().find(|(_, ty)| ty.name.as_deref().map(plain) == Some(plain(name)));
    match found.map(|(_, ty)| &ty.inner) {
        Some(TypeInner::Struct { members, span }) => (members, *span),
        other => panic!("{name} is {other:?}"),
    }
}

/// The struct's fields and its size.
pub fn fields_of(module: &Module, name: &str) -> (Vec<Field>, u32) {
    let (members, span) = struct_of(module, name);
    let fields = members.iter().map(|member| {
        let inner = &module.types[member.ty].inner;
        (member.name.clone().unwrap_or_default(), member.offset, inner.size(module.to_ctx()), is_float(module, inner))
    });
    (fields.collect(), span)
}

fn is_float(module: &Module, inner: &TypeInner) -> bool {
    match inner {
        TypeInner::Scalar(Scalar { kind, width: 4 })
        | TypeInner::Atomic(Scalar { kind, width: 4 })
        | TypeInner::Vector { scalar: Scalar { kind, width: 4 }, .. }
        | TypeInner::Matrix { scalar: Scalar { kind, width: 4 }, .. } => *kind == ScalarKind::Float,
        TypeInner::Array { base, size: ArraySize::Constant(_), .. } => is_float(module, &module.types[*base].inner),
        TypeInner::Struct { members, .. } => is_float(module, &module.types[members[0].ty].inner),
        other => panic!("not of 4-byte numbers: {other:?}"),
    }
}

/// Whether a type of Rust is made of f32, else of u32.
pub trait Numbers {
    /// Whether it is f32.
    const FLOAT: bool;
}

impl Numbers for f32 {
    const FLOAT: bool = true;
}

impl Numbers for u32 {
    const FLOAT: bool = false;
}

impl<T: Numbers, const N: usize> Numbers for [T; N] {
    const FLOAT: bool = T::FLOAT;
}

/// The size of a field in bytes, and whether it holds floats.
pub fn sized<T, F: Numbers>(_: impl Fn(&T) -> &F) -> (u32, bool) {
    (size_of::<F>() as u32, F::FLOAT)
}

/// The fields of a Rust struct. Where WGSL has several in the place of one (the columns of a matrix) their names follow it.
macro_rules! fields {
    ($ty:ty: $($field:ident $([$($part:literal),+])?),+ $(,)?) => {{
        let mut fields: Vec<$crate::layout::Field> = Vec::new();
        $(
            let (size, float) = $crate::layout::sized(|value: &$ty| &value.$field);
            let names: Vec<String> = vec![$($($part.to_owned()),+)?];
            let names = if names.is_empty() { vec![stringify!($field).to_owned()] } else { names };
            let each = size / names.len() as u32;
            let start = std::mem::offset_of!($ty, $field) as u32;
            fields.extend(names.into_iter().enumerate().map(|(k, name)| (name, start + k as u32 * each, each, float)));
        )+
        (fields, std::mem::size_of::<$ty>() as u32)
    }};
}
pub(crate) use fields;
