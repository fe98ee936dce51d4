//! Paths and values on the command line, and what is said about them.

use serde_json::Value;

use super::Desk;

/// A desk with one node, and one output written with a `./`.
fn desk() -> Desk {
    let desk = Desk::new();
    let text = r#"Graph(version: 1,
    params: {
        "side": Number(default: 2, min: 1, max: 9, unit: Length),
        "times": Integer(default: 2),
        "way": Choice(default: Up, of: [Up, Down]),
        "open": Bool(default: true),
    },
    nodes: {"l": Length(value: "side * times"), "m": Length(value: "if(open, 1, 2)")},
    outputs: {"./out/l.json": "l", "m.json": "m"})"#;
    desk.write("g.ron", text);
    desk
}

#[test]
fn a_wrong_value_is_wrong_usage_and_its_help_is_right() {
    let desk = desk();
    for (set, message, help) in [
        (
            "side=nan",
            "`side` takes a number",
            "write a number such as 0.12",
        ),
        (
            "side=inf",
            "`side` takes a number",
            "write a number such as 0.12",
        ),
        (
            "side=wide",
            "`side` takes a number",
            "write a number such as 0.12",
        ),
        ("side=10", "9", "give a value within it"),
        (
            "times=1.5",
            "`times` takes a whole number",
            "write a whole number such as 3",
        ),
        (
            "times=nan",
            "`times` takes a whole number",
            "write a whole number such as 3",
        ),
        (
            "open=yes",
            "`open` takes true or false",
            "write true or false",
        ),
        ("way=Upp", "`way` cannot be `Upp`", "did you mean `Up`"),
        (
            "sid=1",
            "the graph has no parameter `sid`",
            "did you mean `side`",
        ),
    ] {
        for command in ["run", "check", "graph"] {
            let given = desk.command(command, &["--set", set]);
            assert_eq!(given.status, 2, "{set}: {}", given.err);
            assert!(given.err.contains("error[wrong_setting]"), "{}", given.err);
            assert!(given.err.contains(message), "{set}: {}", given.err);
            assert!(given.err.contains(help), "{set}: {}", given.err);
        }
    }
    // A whole number may be written as any number.
    for set in ["times=3", "times=3.0", "times=3e0", "side=3"] {
        assert_eq!(desk.command("check", &["--set", set]).status, 0, "{set}");
    }
    // A graph that is wrong itself is no matter of usage.
    let text = desk
        .text("g.ron")
        .replace("\"l\": Length", "\"l\": Lengthy");
    desk.write("g.ron", &text);
    assert_eq!(desk.command("check", &["--set", "side=nan"]).status, 1);
}

#[test]
fn an_output_is_named_with_or_without_a_dot() {
    let desk = desk();
    for only in [
        "out/l.json",
        "./out/l.json",
        "out//l.json",
        "./m.json",
        "m.json",
    ] {
        let given = desk.command("run", &["--only", only]);
        assert_eq!(given.status, 0, "{only}: {}", given.err);
        let told = given.err.matches(".json").count();
        assert_eq!(told, 1, "{only}: {}", given.err);
    }
    assert_eq!(desk.command("run", &["--only", "out/m.json"]).status, 2);
}

#[test]
fn outputs_go_to_a_folder_and_not_to_a_file() {
    let desk = desk();
    let file = desk.write("taken", "mine").to_string_lossy().into_owned();
    let given = desk.command("run", &["--out", &file]);
    assert_eq!(given.status, 2, "{}", given.err);
    assert!(
        given.err.contains("is a file, not a folder"),
        "{}",
        given.err
    );
    assert!(!given.err.contains("computed"), "{}", given.err);
    let below = desk.path("taken/deeper").to_string_lossy().into_owned();
    let given = desk.command("run", &["--out", &below]);
    assert_eq!(given.status, 1, "{}", given.err);
    assert!(!given.err.contains("computed"), "{}", given.err);
    assert_eq!(desk.text("taken"), "mine");
}

#[test]
fn check_finds_files_that_are_missing_or_not_allowed() {
    let desk = Desk::new();
    let outside = Desk::new();
    let far = outside
        .write("far.txt", "far")
        .to_string_lossy()
        .into_owned();
    std::fs::create_dir(desk.path("folder")).unwrap();
    desk.write("here.txt", "here");
    let text = format!(
        "Graph(version: 1, params: {{\"from\": Path(default: \"nowhere.txt\")}}, nodes: {{\n\
         \"a\": Reads(path: \"here.txt\"),\n\
         \"b\": Reads(path: \"gone.txt\"),\n\
         \"c\": Reads(path: \"{{from}}\"),\n\
         \"d\": Reads(path: \"{far}\"),\n\
         \"e\": Reads(path: \"folder\"),\n\
         }}, outputs: {{\"a.json\": \"a\"}})"
    );
    desk.write("g.ron", &text);
    let given = desk.command("check", &["--message-format", "json"]);
    assert_eq!(given.status, 1);
    let problems: Vec<Value> = given
        .out
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    let places: Vec<_> = problems.iter().map(|problem| &problem["line"]).collect();
    assert_eq!(places, [3, 4, 5, 6], "{}", given.out);
    for (problem, reason) in problems.iter().zip([
        "cannot read `gone.txt`: there is no such file",
        "cannot read `nowhere.txt`: there is no such file",
        "allow it with `--allow",
        "cannot read `folder`: it is a folder",
    ]) {
        assert_eq!(problem["code"], "missing_file");
        let message = problem["message"].as_str().unwrap();
        assert!(message.contains(reason), "{message}");
    }
    let allowed = outside.path("").to_string_lossy().into_owned();
    let given = desk.command("check", &["--allow", &allowed, "--set", "from=here.txt"]);
    assert!(given.err.contains("2 errors in"), "{}", given.err);
}

#[test]
fn an_input_is_named_as_it_is_written() {
    let desk = Desk::new();
    desk.write("data/in.json", "input");
    let text = "Graph(version: 1, nodes: {\"r\": Reads(path: \"./data/in.json\")}, \
                outputs: {\"data/in.json\": \"r\"})";
    desk.write("g.ron", text);
    let given = desk.command("run", &[]);
    assert!(
        given
            .err
            .contains("would overwrite an input of the graph, `./data/in.json`"),
        "{}",
        given.err
    );
    let onto_itself = text.replace(
        "{\"data/in.json\": \"r\"}",
        "{\"g.ron\": \"r\", \"g.json\": \"r\"}",
    );
    desk.write("g.ron", &onto_itself);
    assert_eq!(desk.command("run", &[]).status, 1);
    assert_eq!(desk.text("g.ron"), onto_itself);
}

#[test]
fn the_next_step_can_be_copied_as_it_is() {
    let desk = Desk::new();
    let plain = desk.program(&["new", &desk.path("villa").to_string_lossy()]);
    let line = |text: &str| {
        let line = text.lines().find(|line| line.contains("tessgraph run"));
        line.expect("a next step").trim().to_owned()
    };
    assert!(!line(&plain.err).contains('\''), "{}", plain.err);
    let folder = desk.path("it's A b");
    let given = desk.program(&["new", &folder.to_string_lossy()]);
    assert_eq!(given.status, 0);
    #[cfg(unix)]
    {
        let echo = line(&given.err).replace("tessgraph run", "printf %s");
        let shell = std::process::Command::new("sh")
            .args(["-c", &echo])
            .output();
        let said = String::from_utf8(shell.unwrap().stdout).unwrap();
        assert_eq!(said, folder.join("facade.ron").to_string_lossy());
    }
}

#[test]
fn an_empty_mesh_is_written_with_a_note() {
    let desk = Desk::new();
    let text = "Graph(version: 1, nodes: {\"s\": Nothing()}, outputs: {\"s.obj\": \"s\"})";
    desk.write("g.ron", text);
    let given = desk.command("run", &[]);
    assert_eq!(given.status, 0, "{}", given.err);
    assert!(
        given.err.contains("s.obj: the mesh is empty"),
        "{}",
        given.err
    );
}

#[test]
fn one_of_a_kind_is_said_so() {
    let desk = Desk::new();
    let faces = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 3\n";
    let path = desk
        .write("twice.obj", faces)
        .to_string_lossy()
        .into_owned();
    let given = desk.program(&["info", &path]);
    assert!(
        given.out.contains("1 face repeats another: 1"),
        "{}",
        given.out
    );
    let text = r#"Graph(version: 1, nodes: {
        "base": Grid(cells: [1, 1]),
        "one": SetAttribute(mesh: "base", name: "tall", value: 1),
        "two": SetAttribute(mesh: "one", name: "wide", value: 1),
    }, outputs: {"one.obj": "one", "two.obj": "two"})"#;
    let graph = desk.write("g.ron", text).to_string_lossy().into_owned();
    let given = desk.program(&["run", &graph]);
    assert!(
        given.err.contains("no place for the attribute `tall`"),
        "{}",
        given.err
    );
    assert!(
        given
            .err
            .contains("no place for the attributes `tall`, `wide`"),
        "{}",
        given.err
    );
}

#[test]
fn completions_and_manual_pages_know_every_command() {
    let desk = Desk::new();
    let commands = [
        "run", "check", "nodes", "info", "new", "graph", "cache", "man",
    ];
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let given = desk.program(&["completions", shell]);
        assert_eq!((given.status, given.err.as_str()), (0, ""), "{shell}");
        for command in commands {
            assert!(given.out.contains(command), "{command} for {shell}");
        }
    }
    assert_eq!(desk.program(&["completions", "cmd"]).status, 2);
    let page = desk.program(&["man"]);
    assert_eq!(page.status, 0);
    for command in commands {
        assert!(
            page.out.contains(&format!("tessgraph\\-{command}")),
            "{command}"
        );
    }
    let page = desk.program(&["man", "run"]);
    assert!(
        page.out.contains(".TH") && page.out.contains("\\-\\-threads"),
        "{}",
        page.out
    );
    let wrong = desk.program(&["man", "rum"]);
    assert!(
        wrong.status == 2 && wrong.err.contains("did you mean `run`"),
        "{}",
        wrong.err
    );
}
