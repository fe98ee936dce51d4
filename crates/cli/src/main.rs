//! The `tessgraph` program.

/// Ends the program in order where it would pass its memory limit.
#[global_allocator]
static MEMORY: tessgraph::MemoryGuard = tessgraph::MemoryGuard;

fn main() -> std::process::ExitCode {
    tessgraph::main()
}
