//! The peer as a judge: the same expressions through fidget give the same values, gradients and silhouettes.

use fidget::types::Grad;
use freikugel::field::{Evaluator, Field, Points};
use freikugel::render::{Options, Renderer};
use freikugel_bench::evaluation::{points, program};
use freikugel_bench::peer::{BACKENDS, Backend, Peer, View, with_derivatives};
use freikugel_bench::{fields, picture};

/// How far values may lie apart, relative to 1 and to themselves: both round to single precision after each operation, and
/// the operations are the same but for the order of sums.
const CLOSE: f32 = 2e-5;

/// As [`CLOSE`], for gradients, which cancel more.
const CLOSE_GRADIENTS: f32 = 1e-3;

/// Where operands of a minimum tie, the sides may differ in whose gradient it is; so many of all points at most.
const TIES: f64 = 0.002;

/// Values are compared up to this size: the fractals' grow without bounds, and with them the rounding errors.
const LARGEST: f32 = 10.0;

fn cases() -> Vec<(&'static str, Field)> {
    vec![
        ("csg20", fields::csg20()),
        ("many256", fields::many(256)),
        ("gyroid", fields::gyroid()),
        // Few iterations: each one doubles the errors of those before, and the angles of the last ones are noise.
        ("julia", fields::julia(3)),
        ("mandelbulb", fields::mandelbulb(1)),
    ]
}

fn is_close(a: f32, b: f32, tolerance: f32) -> bool {
    (a - b).abs() <= tolerance * (1.0 + a.abs().max(b.abs()))
}

#[test]
fn values_agree_with_the_peer() {
    const COUNT: usize = 3000;
    let [x, y, z] = points(COUNT);
    for (name, field) in cases() {
        let program = program(field);
        let mut ours = vec![0.0; COUNT];
        Evaluator::new(&program).values(Points { x: &x, y: &y, z: &z }, &mut ours);
        let peer = Peer::translate(&program).expect("fidget has all operations");
        for (backend, backend_name) in BACKENDS {
            let theirs = peer.list(backend, [&x, &y, &z]);
            let mut compared = 0;
            for (index, (&ours, &theirs)) in ours.iter().zip(&theirs).enumerate() {
                if ours.abs() < LARGEST {
                    compared += 1;
                    let at = (x[index], y[index], z[index]);
                    assert!(is_close(ours, theirs, CLOSE), "{name} at {at:?}: {ours}, {backend_name}: {theirs}");
                }
            }
            assert!(compared > COUNT / 2, "{name}: only {compared} points count");
        }
    }
}

#[test]
fn gradients_agree_with_the_peer() {
    const COUNT: usize = 3000;
    let [x, y, z] = points(COUNT);
    let with_derivatives: [Vec<Grad>; 3] = with_derivatives([&x, &y, &z]);
    for (name, field) in cases().into_iter().take(3) {
        let program = program(field);
        let (mut values, mut gx, mut gy, mut gz) =
            (vec![0.0; COUNT], vec![0.0; COUNT], vec![0.0; COUNT], vec![0.0; COUNT]);
        let points = Points { x: &x, y: &y, z: &z };
        Evaluator::new(&program).gradients(points, &mut values, [&mut gx, &mut gy, &mut gz]);
        let peer = Peer::translate(&program).expect("fidget has all operations");
        for (backend, backend_name) in BACKENDS {
            let theirs = peer.list_gradients(backend, &with_derivatives);
            let differs = |index: &usize| {
                let ours = [gx[*index], gy[*index], gz[*index]];
                !ours.iter().zip(theirs[*index]).all(|(&a, b)| is_close(a, b, CLOSE_GRADIENTS))
            };
            let different = (0..COUNT).filter(differs).count();
            assert!((different as f64) < TIES * COUNT as f64, "{name}, {backend_name}: {different} of {COUNT} differ");
        }
    }
}

#[test]
fn silhouettes_agree_with_the_peer() {
    // Voxels cover what lies in front of their middles, rays hit within a fraction of a pixel: both cut the border
    // somewhere in its pixels.
    const BORDER: f64 = 0.04;
    let view = View { width: 96, height: 64, scale: 1.1 };
    let scene = picture::scene(fields::csg20(), view.scale);
    let options = Options { width: view.width, height: view.height, ..Options::default() };
    let renderer = Renderer::new(&scene).expect("a sound scene");
    let (layers, _) = renderer.layers(&options, &()).expect("nobody cancels");
    let ours: Vec<bool> = layers.pixels().iter().map(|pixel| pixel.object.is_some()).collect();
    let peer = Peer::translate(&program(fields::csg20())).expect("fidget has all operations");
    let camera = scene.camera.as_ref().expect("the scene has a camera");
    let theirs = peer.voxels(Backend::Vm, camera, view, 1)();
    let covered = ours.iter().filter(|&&hit| hit).count();
    let different = ours.iter().zip(&theirs).filter(|(a, b)| a != b).count();
    assert!(covered > 500, "{covered} pixels are covered");
    assert!((different as f64) < BORDER * covered as f64, "{different} of {covered} pixels differ");
}
