//! What the processor allocates for a frame before the device is told of it: nothing, where nothing new appears.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use lensrunner::render::Renderer;
use lensrunner::render::shot::Moment;
use lensrunner::render::stage::{Stage, settings};
use lensrunner::scene::{GameConfig, load};

use crate::gpu::GPU;
use crate::render::support::renderer;

/// The system's allocator, which counts what each thread asks it for.
struct Counting;

thread_local! {
    static ASKED: Cell<u64> = const { Cell::new(0) };
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

#[allow(unsafe_code, reason = "an allocator cannot be written otherwise; this one hands on")]
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ASKED.set(ASKED.get() + 1);
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        ASKED.set(ASKED.get() + 1);
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        ASKED.set(ASKED.get() + 1);
        unsafe { System.realloc(pointer, layout, size) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { System.dealloc(pointer, layout) }
    }
}

/// How often this thread allocates in some work.
fn counted(work: impl FnOnce()) -> u64 {
    let before = ASKED.get();
    work();
    ASKED.get() - before
}

const SIZE: [u32; 2] = [160, 90];
/// Frames until all has been seen once.
const WARM: usize = 8;
/// Frames that follow.
const MOVING: usize = 24;

/// Frames of a scene, a step of the clock apart, and at the end one once more: what placing, handing over and planning of each allocate;
/// and whether an image, a part of a curtain or a row of the aurora came.
fn allocates(renderer: &mut Renderer, scene: &str) -> Vec<([u64; 3], bool)> {
    let config = GameConfig::default();
    let scene = load(scene).unwrap();
    let mut stage = Stage::new(renderer, &scene, &config).watched();
    let mut moment = Moment::new(&scene, &config, 2.0, 1);
    let settings = settings(&config);
    let (mut shown, mut drawn) = (None, None);
    let [mut images, mut parts, mut row] = [0; 3];
    let frame = |number: usize| {
        if number < WARM + MOVING {
            moment.advance(1);
        }
        let (camera, histories) = (stage.camera(moment.time(), &moment.ships()), moment.histories());
        let placing = counted(|| {
            if let Some(before) = shown.take() {
                stage.reuse(before);
            }
            shown = Some(stage.frame(camera, SIZE, moment.time(), &histories, None, &settings));
        });
        let extracting = counted(|| drawn.clone_from(&shown));
        let frame = drawn.as_ref().expect("it was made");
        let planning = counted(|| assert!(renderer.plan(frame)));
        renderer.prepare_resources(frame);
        renderer.prepare_bind_groups();
        GPU.queue.submit([]);
        let aurora = frame.aurora.as_ref();
        let newest = aurora.map_or(0, |aurora| aurora.rows.newest());
        let part = aurora.map_or(0, |aurora| aurora.segments.len());
        let is_new = frame.placed.len() > images || part > parts || newest != row;
        (images, parts, row) = (frame.placed.len(), part.max(parts), newest);
        ([placing, extracting, planning], is_new)
    };
    (0..WARM + MOVING + 2).map(frame).collect()
}

#[test]
fn a_frame_without_anything_new_allocates_nothing() {
    let mut renderer = renderer(SIZE);
    for scene in ["chase", "swarm", "parade", "disk", "aurora-orbit"] {
        let all = allocates(&mut renderer, scene);
        println!("{scene}: {all:?}");
        assert!(all[WARM..].iter().all(|&(counts, is_new)| is_new || counts == [0; 3]), "{scene}: {all:?}");
        assert_eq!(all[all.len() - 1], ([0; 3], false), "{scene}: the same frame once more");
    }
}
