//! The same bytes for any number of threads.

use tessgraph_graph::Plan;

use crate::support::{self, Ran, workspace};

/// Digests of everything a plan computes, on a pool of `threads`.
fn digests(plan: &Plan, threads: usize) -> Vec<String> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .expect("a pool");
    let world = support::world_of(&workspace().join("graphs"));
    pool.install(|| {
        let ran = Ran::run(plan.clone(), &world);
        let results = support::everything(&ran.plan);
        results
            .into_iter()
            .map(|result| {
                let name = &ran.plan.nodes[result.node].name;
                let value = ran
                    .evaluation
                    .value(result)
                    .map(|value| value.digest().to_string());
                format!("{name}.{}: {value:?}", result.result)
            })
            .collect()
    })
}

#[test]
fn every_result_of_every_graph_is_the_same_on_1_2_and_7_threads() {
    for name in [
        "facade",
        "narrow_fold",
        "vault",
        "torus",
        "evaluate_normals",
        "wave",
    ] {
        let text = support::text_of(&workspace().join(format!("graphs/{name}.ron")));
        let plan = support::load(name, &text);
        let alone = digests(&plan, 1);
        assert!(
            alone.iter().all(|line| line.contains("Some")),
            "{name}: {alone:?}"
        );
        assert_eq!(alone, digests(&plan, 2), "{name}");
        assert_eq!(alone, digests(&plan, 7), "{name}");
    }
}
