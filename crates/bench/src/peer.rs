//! The peer fidget (<https://github.com/mkeeter/fidget>): our fields in its terms, and its evaluators and pictures.

use fidget::context::{BadNode, Context, Node};
use fidget::eval::{BulkEvaluator, Function};
use fidget::jit::JitFunction;
use fidget::raster::{pixel, voxel};
use fidget::render::{CancelToken, ImageSize, RenderHints, ThreadPool, VoxelSize};
use fidget::shape::{EzShape, Shape, ShapeVars};
use fidget::types::Grad;
use fidget::vm::VmFunction;
use freikugel::field::Program;
use freikugel::field::expr::{Binary, Graph, Term, Unary};
use freikugel::scene::Camera;
use nalgebra::{Matrix3, Matrix4, Rotation3, Vector3};

/// How fidget evaluates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Backend {
    /// By interpretation.
    Vm,
    /// By machine code made at run time.
    Jit,
}

/// All ways of evaluation, with their names.
pub const BACKENDS: [(Backend, &str); 2] = [(Backend::Vm, "fidget VM"), (Backend::Jit, "fidget JIT")];

/// An expression in fidget's terms.
pub struct Peer {
    context: Context,
    root: Node,
}

impl Peer {
    /// The very operations of our program.
    ///
    /// # Errors
    /// If it has an operation that fidget lacks.
    pub fn translate(program: &Program) -> Result<Self, String> {
        let graph = Graph::new();
        let root = program.expression(&graph).id();
        if !graph.loops().is_empty() {
            return Err("fidget has no loops".into());
        }
        let mut context = Context::new();
        let mut nodes: Vec<Node> = Vec::new();
        for term in graph.terms() {
            let node = operation(&mut context, term, &nodes, program.constants());
            nodes.push(node.map_err(|error| error.to_string())?);
        }
        Ok(Self { context, root: nodes[root as usize] })
    }

    /// A model as fidget reads it.
    ///
    /// # Errors
    /// What fidget says of it.
    pub fn read(text: &str) -> Result<Self, String> {
        let (context, root) = Context::from_text(text.as_bytes()).map_err(|error| error.to_string())?;
        Ok(Self { context, root })
    }

    fn shape<F: fidget::eval::MathFunction>(&self) -> Shape<F> {
        Shape::new(&self.context, self.root).expect("the root belongs to the context")
    }

    /// A function that computes the values at some points.
    pub fn values<'a>(&self, backend: Backend, points: [&'a [f32]; 3]) -> Box<dyn FnMut() -> f32 + 'a> {
        match backend {
            Backend::Vm => bulk(&self.shape::<VmFunction>(), points),
            Backend::Jit => bulk(&self.shape::<JitFunction>(), points),
        }
    }

    /// A function that computes the values and gradients at some points.
    pub fn gradients<'a>(&self, backend: Backend, points: &'a [Vec<Grad>; 3]) -> Box<dyn FnMut() -> f32 + 'a> {
        match backend {
            Backend::Vm => bulk_gradients(&self.shape::<VmFunction>(), points),
            Backend::Jit => bulk_gradients(&self.shape::<JitFunction>(), points),
        }
    }

    /// The values at some points, one by one.
    pub fn list(&self, backend: Backend, [x, y, z]: [&[f32]; 3]) -> Vec<f32> {
        fn list<F: Function>(shape: &Shape<F>, x: &[f32], y: &[f32], z: &[f32]) -> Vec<f32> {
            let tape = shape.ez_float_slice_tape();
            let mut evaluator = Shape::<F>::new_float_slice_eval();
            evaluator.eval(&tape, x, y, z).expect("there are no variables").to_vec()
        }
        match backend {
            Backend::Vm => list(&self.shape::<VmFunction>(), x, y, z),
            Backend::Jit => list(&self.shape::<JitFunction>(), x, y, z),
        }
    }

    /// The gradients at some points, one by one.
    pub fn list_gradients(&self, backend: Backend, points: &[Vec<Grad>; 3]) -> Vec<[f32; 3]> {
        fn list<F: Function>(shape: &Shape<F>, [x, y, z]: &[Vec<Grad>; 3]) -> Vec<[f32; 3]> {
            let tape = shape.ez_grad_slice_tape();
            let mut evaluator = Shape::<F>::new_grad_slice_eval();
            let all = evaluator.eval(&tape, x, y, z).expect("there are no variables");
            all.iter().map(|grad| [grad.dx, grad.dy, grad.dz]).collect()
        }
        match backend {
            Backend::Vm => list(&self.shape::<VmFunction>(), points),
            Backend::Jit => list(&self.shape::<JitFunction>(), points),
        }
    }

    /// A function that draws a section of the square from -1 to 1, and says how many pixels are inside.
    pub fn section(&self, backend: Backend, side: u32, threads: usize) -> Box<dyn FnMut() -> usize> {
        fn section<F: Function + RenderHints + Clone + 'static>(
            shape: Shape<F>,
            side: u32,
            threads: usize,
        ) -> Box<dyn FnMut() -> usize> {
            let pool = pool(threads);
            let config = pixel::RenderConfig {
                world_to_model: Matrix3::identity(),
                ..pixel::RenderConfig::from_size(ImageSize::from(side))
            };
            Box::new(move || {
                let vars = ShapeVars::new();
                let bound = shape.bind(&vars).expect("there are no variables");
                let settings =
                    pixel::EvalConfig { tile_sizes: None, threads: pool.as_ref(), cancel: CancelToken::new() };
                let image = pixel::render(bound, &config, &settings).expect("nobody cancels");
                image.iter().filter(|pixel| pixel.inside()).count()
            })
        }
        match backend {
            Backend::Vm => section(self.shape::<VmFunction>(), side, threads),
            Backend::Jit => section(self.shape::<JitFunction>(), side, threads),
        }
    }

    /// A function that draws voxels with normals as an orthographic camera sees them, and says which pixels are covered.
    pub fn voxels(
        &self,
        backend: Backend,
        camera: &Camera,
        view: View,
        threads: usize,
    ) -> Box<dyn FnMut() -> Vec<bool>> {
        fn voxels<F: Function + RenderHints + Clone + 'static>(
            shape: Shape<F>,
            world_to_model: Matrix4<f32>,
            View { width, height, .. }: View,
            threads: usize,
        ) -> Box<dyn FnMut() -> Vec<bool>> {
            let pool = pool(threads);
            let size = VoxelSize::new(width, height, width.min(height));
            let config = voxel::RenderConfig { world_to_model, ..voxel::RenderConfig::from_size(size) };
            Box::new(move || {
                let vars = ShapeVars::new();
                let bound = shape.bind(&vars).expect("there are no variables");
                let settings =
                    voxel::EvalConfig { tile_sizes: None, threads: pool.as_ref(), cancel: CancelToken::new() };
                let image = voxel::render(bound, &config, &settings).expect("nobody cancels");
                image.iter().map(|pixel| pixel.depth > 0).collect()
            })
        }
        let matrix = world_to_model(camera, view.scale);
        match backend {
            Backend::Vm => voxels(self.shape::<VmFunction>(), matrix, view, threads),
            Backend::Jit => voxels(self.shape::<JitFunction>(), matrix, view, threads),
        }
    }
}

/// The size of a picture in voxels, and half the length of its shorter side in the model.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Half the length of the shorter side.
    pub scale: f64,
}

/// None for work on the calling thread.
fn pool(threads: usize) -> Option<ThreadPool> {
    let pool = || rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads start");
    (threads > 1).then(|| ThreadPool::Custom(pool()))
}

/// The map from fidget's view, which looks against its z with y up, to the model that an orthographic camera looks at.
fn world_to_model(camera: &Camera, scale: f64) -> Matrix4<f32> {
    let back = (camera.eye - camera.target).normalize();
    let right = camera.up.cross(back).normalize();
    let up = back.cross(right);
    let column = |v: glam::DVec3| Vector3::new(v.x as f32, v.y as f32, v.z as f32);
    let turned = Matrix3::from_columns(&[column(right), column(up), column(back)]);
    let turned = Rotation3::from_matrix_unchecked(turned).to_homogeneous() * Matrix4::new_scaling(scale as f32);
    let target = column(camera.target);
    Matrix4::new_translation(&target) * turned
}

fn bulk<'a, F: Function + 'a>(shape: &Shape<F>, [x, y, z]: [&'a [f32]; 3]) -> Box<dyn FnMut() -> f32 + 'a>
where
    F::FloatSliceEval: 'a,
    <F::FloatSliceEval as BulkEvaluator>::Tape: 'a,
{
    let tape = shape.ez_float_slice_tape();
    let mut evaluator = Shape::<F>::new_float_slice_eval();
    Box::new(move || evaluator.eval(&tape, x, y, z).expect("there are no variables")[0])
}

fn bulk_gradients<'a, F: Function + 'a>(shape: &Shape<F>, [x, y, z]: &'a [Vec<Grad>; 3]) -> Box<dyn FnMut() -> f32 + 'a>
where
    F::GradSliceEval: 'a,
    <F::GradSliceEval as BulkEvaluator>::Tape: 'a,
{
    let tape = shape.ez_grad_slice_tape();
    let mut evaluator = Shape::<F>::new_grad_slice_eval();
    Box::new(move || evaluator.eval(&tape, x, y, z).expect("there are no variables")[0].dx)
}

/// Points with the derivatives of their coordinates.
pub fn with_derivatives([x, y, z]: [&[f32]; 3]) -> [Vec<Grad>; 3] {
    let along = |values: &[f32], d: [f32; 3]| values.iter().map(|&v| Grad::new(v, d[0], d[1], d[2])).collect();
    [along(x, [1.0, 0.0, 0.0]), along(y, [0.0, 1.0, 0.0]), along(z, [0.0, 0.0, 1.0])]
}

/// One of our operations in fidget's context. Conditions are 1 and 0.
fn operation(c: &mut Context, term: Term, nodes: &[Node], slots: &[f64]) -> Result<Node, BadNode> {
    let n = |id: u32| nodes[id as usize];
    match term {
        Term::Input(axis) => Ok(c.axes()[axis as usize]),
        Term::Slot(slot) => Ok(c.constant(slots[slot as usize] as f32)),
        Term::Literal(bits) => Ok(c.constant(f64::from_bits(bits) as f32)),
        Term::Unary(op, a) => match op {
            Unary::Neg => c.neg(n(a)),
            Unary::Abs => c.abs(n(a)),
            Unary::Sqrt => c.sqrt(n(a)),
            Unary::Floor => c.floor(n(a)),
            Unary::Sin => c.sin(n(a)),
            Unary::Cos => c.cos(n(a)),
            Unary::Tan => c.tan(n(a)),
            Unary::Asin => c.asin(n(a)),
            Unary::Acos => c.acos(n(a)),
            Unary::Atan => c.atan(n(a)),
            Unary::Exp => c.exp(n(a)),
            Unary::Ln => c.ln(n(a)),
            Unary::Not => c.not(n(a)),
        },
        Term::Binary(op, a, b) => match op {
            Binary::Add => c.add(n(a), n(b)),
            Binary::Sub => c.sub(n(a), n(b)),
            Binary::Mul if a == b => c.square(n(a)),
            Binary::Mul => c.mul(n(a), n(b)),
            Binary::Div => c.div(n(a), n(b)),
            Binary::Min => c.min(n(a), n(b)),
            Binary::Max => c.max(n(a), n(b)),
            Binary::Atan2 => c.atan2(n(a), n(b)),
            Binary::Less => c.less_than(n(a), n(b)),
            Binary::And => c.and(n(a), n(b)),
            Binary::Or => c.or(n(a), n(b)),
            // As the power of a positive number; fidget has no other.
            Binary::Pow => {
                let ln = c.ln(n(a))?;
                let exponent = c.mul(n(b), ln)?;
                c.exp(exponent)
            }
        },
        Term::Length(a, b, third) => {
            let mut sum = c.square(n(a))?;
            for other in [Some(b), third].into_iter().flatten() {
                let square = c.square(n(other))?;
                sum = c.add(sum, square)?;
            }
            c.sqrt(sum)
        }
        Term::Select(condition, yes, no) => c.if_nonzero_else(n(condition), n(yes), n(no)),
        Term::State(..) | Term::RowSlot(..) | Term::Result(..) => unreachable!("there are no loops"),
        Term::Entry(..) => unreachable!("there are no trees"),
    }
}
