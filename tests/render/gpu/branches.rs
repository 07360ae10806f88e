//! No compute pass branches on uniforms alone.
//!
//! Lavapipe (Mesa 22 to 24 at least) puts the values of uniforms that decide a branch or the end of a loop into the shader as constants and
//! compiles it again whenever their buffer was written, that is in every frame: half a second for the passes of the disk. Data from a
//! storage buffer in the condition, or `select` instead of a branch, keeps it from that. The test reads the passes' own intermediate form.

use std::collections::{HashMap, HashSet};

use lensrunner::lensing::methods::Method;
use lensrunner::render::gpu::library::Worldlines;
use lensrunner::render::gpu::shaders::Pass;
use naga::{AddressSpace, Arena, Block, Expression, Function, Handle, LocalVariable, Module, Statement};

/// What a value depends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
enum Source {
    Constant,
    Uniform,
    Varying,
}

/// Functions already walked, by the sources of their arguments.
type Known = HashMap<(Handle<Function>, Vec<Source>), (Source, Vec<String>)>;

struct Walk<'a> {
    module: &'a Module,
    known: &'a mut Known,
    function: &'a Function,
    arguments: Vec<Source>,
    locals: HashMap<Handle<LocalVariable>, Source>,
    /// What is stored in a variable, its initial value included.
    stored: HashMap<Handle<LocalVariable>, HashSet<Handle<Expression>>>,
    calls: HashMap<Handle<Expression>, Source>,
    found: Vec<String>,
}

fn operands(expression: &Expression) -> Vec<Handle<Expression>> {
    match *expression {
        Expression::Access { base, index } => vec![base, index],
        Expression::AccessIndex { base, .. } => vec![base],
        Expression::Splat { value, .. } => vec![value],
        Expression::Swizzle { vector, .. } => vec![vector],
        Expression::Compose { ref components, .. } => components.clone(),
        Expression::Load { pointer } => vec![pointer],
        Expression::Unary { expr, .. } | Expression::As { expr, .. } => vec![expr],
        Expression::Binary { left, right, .. } => vec![left, right],
        Expression::Select { condition, accept, reject } => vec![condition, accept, reject],
        Expression::Math { arg, arg1, arg2, arg3, .. } => [Some(arg), arg1, arg2, arg3].into_iter().flatten().collect(),
        Expression::Relational { argument, .. } => vec![argument],
        _ => Vec::new(),
    }
}

impl Walk<'_> {
    fn source(&self, handle: Handle<Expression>) -> Source {
        let expressions: &Arena<Expression> = &self.function.expressions;
        match expressions[handle] {
            Expression::FunctionArgument(index) => self.arguments[index as usize],
            Expression::GlobalVariable(variable) => match self.module.global_variables[variable].space {
                AddressSpace::Uniform => Source::Uniform,
                _ => Source::Varying,
            },
            Expression::LocalVariable(variable) => match self.locals.get(&variable) {
                // A choice between values is not looked through.
                Some(Source::Uniform) if self.stored[&variable].len() > 1 => Source::Varying,
                source => source.copied().unwrap_or(Source::Constant),
            },
            Expression::CallResult(_) => self.calls.get(&handle).copied().unwrap_or(Source::Varying),
            Expression::Literal(_) | Expression::Constant(_) | Expression::ZeroValue(_) | Expression::Override(_) => Source::Constant,
            ref other => {
                let operands = operands(other);
                if operands.is_empty() {
                    return Source::Varying;
                }
                operands.into_iter().map(|operand| self.source(operand)).max().unwrap_or(Source::Varying)
            }
        }
    }

    /// The variable that a pointer leads to.
    fn variable(&self, pointer: Handle<Expression>) -> Option<Handle<LocalVariable>> {
        match self.function.expressions[pointer] {
            Expression::LocalVariable(variable) => Some(variable),
            Expression::Access { base, .. } | Expression::AccessIndex { base, .. } => self.variable(base),
            _ => None,
        }
    }

    fn note(&mut self, what: &str, condition: Handle<Expression>) {
        if self.source(condition) == Source::Uniform {
            self.found.push(format!("{what} in {}", self.function.name.as_deref().unwrap_or("an entry point")));
        }
    }

    /// Walks a block; `noting` the branches once the variables are known. What the function returns is the greatest source of its returns.
    fn block(&mut self, block: &Block, noting: bool) -> Source {
        let mut returned = Source::Constant;
        for statement in block {
            match statement {
                Statement::Block(inner) => returned = returned.max(self.block(inner, noting)),
                Statement::If { condition, accept, reject } => {
                    if noting {
                        self.note("if", *condition);
                    }
                    returned = returned.max(self.block(accept, noting)).max(self.block(reject, noting));
                }
                Statement::Switch { selector, cases } => {
                    if noting {
                        self.note("switch", *selector);
                    }
                    for case in cases {
                        returned = returned.max(self.block(&case.body, noting));
                    }
                }
                Statement::Loop { body, continuing, break_if } => {
                    returned = returned.max(self.block(body, noting)).max(self.block(continuing, noting));
                    if let (Some(condition), true) = (break_if, noting) {
                        self.note("loop", *condition);
                    }
                }
                Statement::Store { pointer, value } => {
                    if let Some(variable) = self.variable(*pointer) {
                        let source = self.source(*value);
                        self.stored.entry(variable).or_default().insert(*value);
                        let known = self.locals.entry(variable).or_insert(Source::Constant);
                        *known = source.max(*known);
                    }
                }
                Statement::Call { function, arguments, result } => {
                    let given: Vec<_> = arguments.iter().map(|argument| self.source(*argument)).collect();
                    let key = (*function, given.clone());
                    let known = self.known.get(&key).cloned();
                    let (source, found) = known.unwrap_or_else(|| walk(self.module, self.known, &self.module.functions[*function], given));
                    self.known.insert(key, (source, found.clone()));
                    if let Some(result) = result {
                        self.calls.insert(*result, source);
                    }
                    if noting {
                        self.found.extend(found);
                    }
                }
                Statement::Return { value: Some(value) } => returned = returned.max(self.source(*value)),
                _ => {}
            }
        }
        returned
    }
}

/// What a function returns depends on, and its branches on uniforms alone.
fn walk(module: &Module, known: &mut Known, function: &Function, arguments: Vec<Source>) -> (Source, Vec<String>) {
    let mut walk = Walk {
        module,
        known,
        function,
        arguments,
        locals: HashMap::new(),
        stored: HashMap::new(),
        calls: HashMap::new(),
        found: Vec::new(),
    };
    for (variable, local) in function.local_variables.iter() {
        if let Some(init) = local.init {
            walk.locals.insert(variable, walk.source(init));
            walk.stored.entry(variable).or_default().insert(init);
        }
    }
    // Twice: what a loop stores is read by its next round.
    walk.block(&function.body, false);
    walk.block(&function.body, false);
    let returned = walk.block(&function.body, true);
    (returned, walk.found)
}

fn branches_on_uniforms(module: &Module) -> Vec<String> {
    let mut found = Vec::new();
    for entry in module.entry_points.iter().filter(|entry| entry.stage == naga::ShaderStage::Compute) {
        let given = vec![Source::Varying; entry.function.arguments.len()];
        found.extend(walk(module, &mut Known::new(), &entry.function, given).1.into_iter().map(|what| format!("{}: {what}", entry.name)));
    }
    found
}

#[test]
fn no_compute_pass_branches_on_uniforms_alone() {
    let mut found = Vec::new();
    for pass in Pass::ALL {
        for (worldlines, inside) in [(Worldlines::Bodies, false), (Worldlines::Bodies, true), (Worldlines::Rings, false)] {
            let module = pass.module_along(worldlines, Method::default(), inside);
            found.extend(branches_on_uniforms(&module).into_iter().map(|what| format!("{pass:?}, {worldlines:?}, {what}")));
        }
    }
    assert!(found.is_empty(), "{found:#?}");
}

/// The reader itself finds what it looks for, and nothing else.
#[test]
fn branches_on_uniforms_are_found() {
    let pass = |body: &str| {
        let source = format!(
            "struct Frame {{ flag: u32, count: u32 }}
             @group(0) @binding(0) var<uniform> frame: Frame;
             @group(0) @binding(1) var<storage, read_write> data: array<u32>;
             fn called(on: bool, x: u32) -> u32 {{ if on {{ return x * 2u; }} return x; }}
             @compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3<u32>) {{ {body} }}"
        );
        naga::front::wgsl::parse_str(&source).unwrap_or_else(|wrong| panic!("{}", wrong.emit_to_string(&source)))
    };
    for bad in [
        "if (frame.flag & 1u) != 0u { data[0] = 1u; }",
        "let flag = frame.flag; if flag == 1u && data[0] == 2u { data[0] = 1u; }",
        "for (var k = 0u; k < frame.count; k++) { data[k] = k; }",
        "data[0] = called(frame.flag == 2u, data[1]);",
        "switch frame.flag { case 1u: { data[0] = 1u; } default: { } }",
    ] {
        assert!(!branches_on_uniforms(&pass(bad)).is_empty(), "{bad}");
    }
    for good in [
        "if id.x >= frame.count { return; } data[0] = 1u;",
        "for (var k = 0u; k < 4u; k++) { data[k] = select(k, 0u, frame.flag == 1u); }",
        "if (frame.flag == 1u) & (data[0] == 2u) { data[0] = 1u; }",
        "for (var k = 0u; k < min(frame.count, arrayLength(&data)); k++) { data[k] = k; }",
    ] {
        assert!(branches_on_uniforms(&pass(good)).is_empty(), "{good}");
    }
}
