//! One thread is enough, however much there is to write.

use tessgraph_graph::{Engine, Outcome};

use super::{MEMORY, Run};

#[test]
fn a_pool_of_one_thread_does_not_wait_for_itself() {
    // More large results than may wait to be written.
    let mut nodes = String::from("\"base\": Grid(cells: (100, 100)),\n");
    for index in 0..60 {
        nodes += &format!("\"n{index}\": Transform(mesh: \"base\", translate: (0, 0, {index})),\n");
    }
    nodes += "\"size\": MeasureMesh(mesh: \"n59\"),\n";
    let outputs: String = (0..60).map(|n| format!("\"{n}.obj\": \"n{n}\",")).collect();
    let text = format!("Graph(version: 1, nodes: {{{nodes}}}, outputs: {{{outputs}}})");
    let folder = tempfile::tempdir().expect("a folder");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    pool.expect("a pool").install(|| {
        let engine = Engine::with_disk(MEMORY, folder.path());
        let cold = Run::with(&engine, &text, false);
        assert_eq!(cold.nodes(Outcome::Computed).len(), 61);
        let warm = Run::with(&Engine::with_disk(MEMORY, folder.path()), &text, false);
        assert_eq!(warm.nodes(Outcome::Cached).len(), 61);
        assert_eq!(warm.digests(), cold.digests());
    });
}
