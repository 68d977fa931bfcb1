//! Keeps the heap between frames. llvmpipe frees and takes large blocks every frame; glibc gives each back to the system at
//! once and pays for its pages again. Where the allocator is another one, there is nothing to do.
//!
//! Measured (glibc 2.36, llvmpipe 22.3.6): textures made, cleared, read and deleted 50 times take 0.7 to 0.9 of the time
//! and 142 MiB at most instead of 169. The pad is address space, not memory: 1 to 64 MiB of it peak alike.

/// Tells glibc to keep what is freed, once a process. To be called before the driver starts.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
pub(super) fn keep() {
    use std::sync::Once;

    const MIB: i32 = 1 << 20;
    static ONCE: Once = Once::new();
    // SAFETY: mallopt takes two integers and may be called at any time; it reports failure by 0, which costs only speed.
    ONCE.call_once(|| unsafe {
        libc::mallopt(libc::M_TRIM_THRESHOLD, 1024 * MIB);
        libc::mallopt(libc::M_MMAP_THRESHOLD, 1024 * MIB);
        libc::mallopt(libc::M_TOP_PAD, 64 * MIB);
    });
}

#[cfg(not(all(target_os = "linux", target_env = "gnu")))]
pub(super) fn keep() {}
