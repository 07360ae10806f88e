//! How much arithmetic the disk's pixels ask for: what docs/disk.md weighs of where shading belongs.

use lensrunner::render::gpu::shaders::Pass;
use naga::valid::{Capabilities, FunctionInfo, ModuleInfo, ValidationFlags, Validator};
use naga::{Block, Expression, Function, Module, Statement, TypeInner};

/// Scalar operations of a shader's function, and fetches of textures; of a loop those of one time round.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Work {
    operations: u32,
    fetches: u32,
    /// The part of both that lies in loops.
    looped: u32,
    looped_fetches: u32,
}

struct Counter<'a> {
    module: &'a Module,
    info: &'a ModuleInfo,
}

impl Counter<'_> {
    fn width(&self, info: &FunctionInfo, handle: naga::Handle<Expression>) -> u32 {
        match info[handle].ty.inner_with(&self.module.types) {
            TypeInner::Vector { size, .. } => *size as u32,
            _ => 1,
        }
    }

    fn function(&self, function: &Function, info: &FunctionInfo) -> Work {
        self.block(function, info, &function.body, false)
    }

    fn block(&self, function: &Function, info: &FunctionInfo, block: &Block, in_loop: bool) -> Work {
        let mut work = Work::default();
        let mut add = |other: Work| {
            work.operations += other.operations;
            work.fetches += other.fetches;
            work.looped += if in_loop { other.operations } else { other.looped };
            work.looped_fetches += if in_loop { other.fetches } else { other.looped_fetches };
        };
        for statement in block {
            match statement {
                Statement::Emit(range) => {
                    for handle in range.clone() {
                        let (operations, fetches) = match function.expressions[handle] {
                            Expression::Math { fun: naga::MathFunction::Dot, arg, .. } => (2 * self.width(info, arg) - 1, 0),
                            Expression::Binary { .. } | Expression::Unary { .. } | Expression::Math { .. } | Expression::Select { .. } => {
                                (self.width(info, handle), 0)
                            }
                            Expression::Derivative { .. } => (self.width(info, handle), 0),
                            Expression::ImageLoad { .. } | Expression::ImageSample { .. } => (0, 1),
                            _ => (0, 0),
                        };
                        add(Work { operations, fetches, ..Work::default() });
                    }
                }
                Statement::Call { function: called, .. } => add(self.function(&self.module.functions[*called], &self.info[*called])),
                Statement::Block(inner) => add(self.block(function, info, inner, in_loop)),
                Statement::If { accept, reject, .. } => {
                    add(self.block(function, info, accept, in_loop));
                    add(self.block(function, info, reject, in_loop));
                }
                Statement::Loop { body, continuing, .. } => {
                    add(self.block(function, info, body, true));
                    add(self.block(function, info, continuing, true));
                }
                _ => {}
            }
        }
        work
    }
}

/// From far and in thin images a pixel has no loop; from near there are two, of up to sixteen and of up to four places.
#[test]
fn pixels_of_the_disk_ask_for_little_arithmetic() {
    let module = Pass::DiskDraw.module();
    let info = Validator::new(ValidationFlags::all(), Capabilities::all()).validate(&module).unwrap();
    let counter = Counter { module: &module, info: &info };
    let work = |name: &str| {
        let index = module.entry_points.iter().position(|entry| entry.name == name).unwrap();
        counter.function(&module.entry_points[index].function, info.get_entry_point(index))
    };
    for (name, most, looped) in
        [("far_fragment", 320, false), ("thin_fragment", 340, false), ("beyond_fragment", 340, false), ("near_fragment", 520, true)]
    {
        let work = work(name);
        println!("{name}: {work:?}");
        assert!(work.operations <= most, "{name} asks for {} operations, {most} were weighed", work.operations);
        assert_eq!(work.looped > 0, looped, "{name}");
    }
}
