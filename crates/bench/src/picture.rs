//! Pictures, computed in this process: sections in 2D, and views in 3D with normals.

use crate::fields;
use crate::measure::{Clock, Contender, Row, Unit};
use crate::peer::{BACKENDS, Backend, Peer, View};
use freikugel::field::Field;
use freikugel::model::{self, Model, Region};
use freikugel::render::{Options, Renderer};
use freikugel::scene::{Camera, Scene};
use glam::DVec3;
use std::hint::black_box;
use std::path::Path;

/// The side of the sections in pixels.
const SECTION: u32 = 1024;

/// Where the views are taken from: from the front right and above, as the peer's own pictures of its models.
const DIRECTION: DVec3 = DVec3::new(0.5, -0.75, 0.6);

/// How far the eye is from the middle: outside everything. Parallel rays look the same from any distance.
const DISTANCE: f64 = 4.0;

/// What is viewed in 3D.
struct Subject {
    field: Field,
    /// The model's text, if the peer reads it itself; otherwise it gets our operations.
    text: Option<String>,
}

/// Makes what is viewed, or says why it can't.
type MakeSubject<'a> = Box<dyn Fn() -> Result<Subject, String> + 'a>;

/// A camera whose view has this half height.
pub fn camera(half: f64) -> Camera {
    Camera::look(DIRECTION.normalize() * DISTANCE, DVec3::ZERO).orthographic(2.0 * half)
}

/// A scene of one field in an orthographic view.
pub fn scene(field: impl Into<Field>, half: f64) -> Scene {
    let mut scene = Scene::of(field);
    scene.camera(camera(half));
    scene
}

/// All rows whose names `is_wanted`. Models are read from `data`; `others` are the numbers of threads besides 1.
pub fn rows(is_wanted: &dyn Fn(&str) -> bool, data: Option<&Path>, others: &[usize]) -> Vec<Row<'static>> {
    let mut rows = Vec::new();
    for file in ["prospero.vm", "hi.vm"] {
        sections(file, is_wanted, data, others, &mut rows);
    }
    for (name, view, field) in subjects(data) {
        let title = |threads: usize| {
            format!("{name}, view with normals, {} x {}, {}", view.width, view.height, counted(threads))
        };
        let wanted: Vec<(usize, String)> = [1]
            .into_iter()
            .chain(others.iter().copied())
            .map(|threads| (threads, title(threads)))
            .filter(|(_, title)| is_wanted(title))
            .collect();
        if wanted.is_empty() {
            continue;
        }
        match field() {
            Ok(subject) => views(subject, view, wanted, &mut rows),
            Err(reason) => rows.extend(wanted.into_iter().map(|(_, title)| missing(title, &reason))),
        }
    }
    rows
}

fn missing(name: String, reason: &str) -> Row<'static> {
    Row { name, unit: Unit::Milliseconds, contenders: vec![Contender::missing("Freikugel", reason)] }
}

/// The text of a model.
fn text_of(data: Option<&Path>, file: &str) -> Result<String, String> {
    let folder = data.ok_or("no folder of models: --data DIR")?;
    std::fs::read_to_string(folder.join(file)).map_err(|error| format!("no {file} in the folder of models: {error}"))
}

fn sections(
    file: &str,
    is_wanted: &dyn Fn(&str) -> bool,
    data: Option<&Path>,
    others: &[usize],
    rows: &mut Vec<Row<'static>>,
) {
    let name = |threads: usize| format!("{file}, section, {SECTION} x {SECTION}, {}", counted(threads));
    let wanted: Vec<usize> =
        [1].into_iter().chain(others.iter().copied()).filter(|&threads| is_wanted(&name(threads))).collect();
    if wanted.is_empty() {
        return;
    }
    let region_and_peer = || -> Result<(Region, Peer), String> {
        let text = text_of(data, file)?;
        match model::read(&text).map_err(|error| error.message)? {
            Model::Region(region) => Ok((region, Peer::read(&text)?)),
            Model::Solid(_) => Err("it is no region of the plane".into()),
        }
    };
    let (region, peer) = match region_and_peer() {
        Ok(both) => both,
        Err(reason) => return rows.extend(wanted.into_iter().map(|threads| missing(name(threads), &reason))),
    };
    let program = crate::evaluation::program(region.field());
    let section = Region::section(SECTION, SECTION);
    let ours = |threads: usize, clock: Clock| {
        let options = Options { width: SECTION, height: SECTION, threads: Some(threads), ..Region::options() };
        let program = program.clone();
        Contender::new(format!("Freikugel, {}", counted(threads)), clock, move || {
            black_box(section.mask(&program, &options, &()).expect("nobody cancels"));
        })
    };
    let theirs = |backend: Backend, name: &str, threads: usize, clock: Clock| {
        let mut work = peer.section(backend, SECTION, threads);
        Contender::new(format!("{name}, {}", counted(threads)), clock, move || {
            black_box(work());
        })
    };
    rows.extend(wanted.into_iter().map(|threads| both(name(threads), threads, &ours, &theirs)));
}

/// The row for a number of threads: with more than one, ours on one thread is there, too.
fn both(
    name: String,
    threads: usize,
    ours: &dyn Fn(usize, Clock) -> Contender<'static>,
    theirs: &dyn Fn(Backend, &str, usize, Clock) -> Contender<'static>,
) -> Row<'static> {
    let clock = if threads == 1 { Clock::Thread } else { Clock::Wall };
    let mut contenders = vec![ours(threads, clock)];
    if threads > 1 {
        contenders.push(ours(1, clock));
    }
    contenders.extend(BACKENDS.map(|(backend, name)| theirs(backend, name, threads, clock)));
    Row { name, unit: Unit::Milliseconds, contenders }
}

/// A number of threads in words.
fn counted(threads: usize) -> String {
    format!("{threads} thread{}", if threads == 1 { "" } else { "s" })
}

/// What is viewed, with its name.
fn subjects(data: Option<&Path>) -> Vec<(&'static str, View, MakeSubject<'_>)> {
    let view = |width, height, scale| View { width, height, scale };
    let own =
        |field: fn() -> Field| -> MakeSubject<'_> { Box::new(move || Ok(Subject { field: field(), text: None })) };
    let colonnade = move || {
        let text = text_of(data, "colonnade.vm")?;
        match model::read(&text).map_err(|error| error.message)? {
            Model::Region(_) => Err("it is no solid".into()),
            Model::Solid(scene) => Ok(Subject { field: scene.objects[0].shape.clone(), text: Some(text) }),
        }
    };
    vec![
        ("csg20", view(640, 360, 1.1), own(fields::csg20)),
        ("many256", view(512, 512, 1.6), own(|| fields::many(256))),
        // As wide as the peer's recommended settings for it.
        ("colonnade.vm", view(512, 512, 1.0 / 0.7), Box::new(colonnade)),
    ]
}

fn views(Subject { field, text }: Subject, view: View, wanted: Vec<(usize, String)>, rows: &mut Vec<Row<'static>>) {
    // It lives as long as the process, as the renderer that borrows it.
    let scene: &'static Scene = Box::leak(Box::new(scene(field, view.scale)));
    let renderer: &'static Renderer<'static> = Box::leak(Box::new(Renderer::new(scene).expect("a sound scene")));
    let peer = match text {
        Some(text) => Peer::read(&text),
        None => Peer::translate(&crate::evaluation::program(scene.objects[0].shape.clone())),
    };
    let View { width, height, .. } = view;
    let ours = |threads: usize, clock: Clock| {
        let options = Options { width, height, threads: Some(threads), ..Options::default() };
        Contender::new(format!("Freikugel, {}", counted(threads)), clock, move || {
            black_box(renderer.layers(&options, &()).expect("nobody cancels"));
        })
    };
    let theirs = |backend: Backend, name: &str, threads: usize, clock: Clock| {
        let name = format!("{name} (voxels), {}", counted(threads));
        let peer = match &peer {
            Ok(peer) => peer,
            Err(reason) => return Contender::missing(name, reason.clone()),
        };
        let camera = scene.camera.as_ref().expect("the scene has a camera");
        let mut work = peer.voxels(backend, camera, view, threads);
        Contender::new(name, clock, move || {
            black_box(work());
        })
    };
    rows.extend(wanted.into_iter().map(|(threads, title)| both(title, threads, &ours, &theirs)));
}
