//! Buffers brought back while other threads wait for the device too.

use std::sync::atomic::{AtomicBool, Ordering};

use lensrunner::render::gpu::layout;
use lensrunner::render::gpu::readback;

use crate::gpu::GPU;

#[test]
fn a_buffer_arrives_that_another_threads_poll_takes() {
    let numbers: Vec<u32> = (0..64).collect();
    let source = layout::storage(&GPU, "numbers", &numbers);
    let is_done = AtomicBool::new(false);
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                while !is_done.load(Ordering::Relaxed) {
                    _ = GPU.device.poll(wgpu::PollType::Poll);
                }
            });
        }
        let lost = (0..500).find_map(|_| readback::buffer(&GPU, &source).err());
        is_done.store(true, Ordering::Relaxed);
        assert!(lost.is_none(), "{lost:?}");
    });
}
