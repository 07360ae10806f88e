//! Scene files: all that ship load, and what is wrong is said with file, line and key.

use std::path::Path;

use glam::DVec3;

use lensrunner::scene::config::GameConfig;
use lensrunner::scene::{Mount, Scene, load, names};
use lensrunner::spacetime::matter::ShipState;

fn complaint(text: &str) -> String {
    Scene::from_toml(Path::new("some/scene.toml"), text).expect_err("must be refused").to_string()
}

#[test]
fn every_scene_loads_and_assembles_without_a_warning() {
    let names = names();
    for wanted in ["chase", "parade", "galaxy", "galaxy-20000", "galaxy-axis", "galaxy-axis-edge", "galaxy-axis-vertex", "ring", "swarm"] {
        assert!(names.iter().any(|name| name == wanted), "{wanted} is missing from {names:?}");
    }
    for name in names {
        let scene = load(&name).unwrap_or_else(|error| panic!("{name}: {error}"));
        let assembly = scene.assemble(&GameConfig::default());
        assert_eq!(assembly.warnings, Vec::<String>::new(), "{name}");
        assert!(assembly.models.iter().all(|model| model.fault().is_none()), "{name}");
    }
}

/// Of every command that takes one, and of the game.
#[test]
fn the_long_help_names_every_scene() {
    let commands: &[&[&str]] =
        if cfg!(feature = "game") { &[&["trace"], &["simulate"], &["shot"], &["play"]] } else { &[&["trace"], &["simulate"]] };
    for command in commands {
        let mut run = std::process::Command::new(env!("CARGO_BIN_EXE_lensrunner"));
        let said = run.args(*command).arg("--help").output().expect("the program starts").stdout;
        let said = String::from_utf8(said).expect("UTF-8");
        let words: Vec<&str> = said.split(|c: char| c.is_whitespace() || c == ',').collect();
        for name in names() {
            assert!(words.contains(&name.as_str()), "{command:?} --help does not name {name}");
        }
    }
}

/// The rain falls from r = 2 in T = (2/3)·2^1.5 = 1.886: of the picture after that, every command that draws one says why there is none.
#[test]
fn no_picture_is_drawn_from_within_the_singularity() {
    let commands: &[&[&str]] = if cfg!(feature = "game") { &[&["trace"], &["shot"]] } else { &[&["trace"]] };
    let output = std::env::temp_dir().join(format!("lensrunner-singularity-{}.png", std::process::id()));
    for command in commands {
        let run = |at: &str| {
            let mut run = std::process::Command::new(env!("CARGO_BIN_EXE_lensrunner"));
            run.args(*command)
                .args(["--scene", "plunge", "--size", "16x9", "--at", at, "-o"])
                .arg(&output)
                .output()
                .expect("the program starts")
        };
        let after = run("1.9");
        let said = String::from_utf8_lossy(&after.stderr).into_owned();
        assert_eq!(after.status.code(), Some(2), "{command:?}: {said}");
        assert!(said.contains("--at: by T = 1.9") && said.contains("singularity") && !output.exists(), "{command:?}: {said}");
    }
    assert!(load("plunge").unwrap().camera.check(1.87, &[]).is_ok());
    // A camera beside a ship that has ended is outside still, and sees as little.
    let chase = load("chase").unwrap();
    let Mount::Follow { ship, .. } = &chase.camera.mount else { panic!("the chase's camera follows a ship") };
    let [here, there] = [4.0, 0.0].map(|r| ShipState::new(DVec3::Z * r, DVec3::ZERO));
    assert!(chase.camera.check(1.0, &[(ship, here)]).is_ok() && chase.camera.check(1.0, &[(ship, there)]).is_err());
}

#[test]
fn scenes_have_the_triangles_they_promise() {
    let triangles = |name: &str| load(name).unwrap().assemble(&GameConfig::default()).triangles();
    assert_eq!(triangles("galaxy"), 2_000);
    assert_eq!(triangles("galaxy-axis"), 2_000);
    assert_eq!(triangles("galaxy-20000"), 20_000);
    assert_eq!(triangles("ring"), 1_224);
    assert!((40_000..60_000).contains(&triangles("parade")), "{}", triangles("parade"));
}

#[test]
fn a_lattice_leaves_the_hole_free() {
    // Three by three by three at a spacing of 1.5: the middle one sits in the hole, the six at 1.5 come to 1.25 with their radius.
    let spheres = |clearance: f64| {
        let text = format!("[[prop]]\nmodel = \"lattice\"\ncount = [3, 3, 3]\nspacing = 1.5\nsize = 0.5\nclearance = {clearance}\n");
        Scene::from_toml(Path::new("a.toml"), &text).unwrap().props[0].positions.len()
    };
    assert_eq!([spheres(1.2), spheres(1.24), spheres(1.26)], [26, 26, 20]);
    let scene = load("parade").unwrap();
    let prop = &scene.props[0];
    assert!(prop.positions.iter().all(|position| position.length() - 0.5 * prop.size >= 1.2));
    assert!(prop.positions.iter().any(|position| position.length() < 2.0));
}

/// Every ship of a swarm is on its orbit, nose first; all of it is filled.
#[test]
fn a_swarm_is_spread_over_its_orbits() {
    let text = "[[ship]]\nname = \"own\"\ntarget = \"drone 7\"\norbit = { radius = 6.0 }\n\
                [[swarm]]\nname = \"drone\"\ncount = 300\nradius = [4.0, 9.0]\ninclination = [0.5, 2.5]\n";
    let scene = Scene::from_toml(Path::new("a.toml"), text).unwrap();
    assert_eq!((scene.ships.len(), scene.ships[7].name.as_str()), (301, "drone 7"));
    let mut filled = [[0; 5]; 3];
    for ship in &scene.ships[1..] {
        let state = ship.state;
        let [r, pole] = [state.position.length(), state.position.cross(state.momentum).normalize().z.acos()];
        assert!((4.0..=9.0).contains(&r) && (0.5..=2.5).contains(&pole), "{ship:?}");
        let circle = lensrunner::spacetime::orbit::circular_momentum(state.position, state.momentum).unwrap();
        assert!(circle.distance(state.momentum) < 1e-12, "{ship:?}");
        assert!((state.attitude * DVec3::NEG_Z).distance(state.momentum.normalize()) < 1e-12, "{ship:?}");
        let azimuth = (state.position.y.atan2(state.position.x) / std::f64::consts::TAU).rem_euclid(1.0);
        for (counts, share) in filled.iter_mut().zip([(r - 4.0) / 5.0, (pole - 0.5) / 2.0, azimuth]) {
            counts[((5.0 * share) as usize).min(4)] += 1;
        }
    }
    assert!(filled.iter().flatten().all(|count| (40..80).contains(count)), "{filled:?}");
}

#[test]
fn the_axis_meets_the_square_where_the_scene_says() {
    // The camera and the origin of the square lie on the z axis, bit by bit, so the axis pierces the square at its own origin.
    let vertices_and_triangles = |name: &str| {
        let scene = load(name).unwrap();
        let Mount::Static(camera) = scene.camera.mount else { panic!("{name}: the camera must be static") };
        assert_eq!((camera.position.x, camera.position.y), (0.0, 0.0), "{name}");
        assert_eq!((scene.props[0].positions[0].x, scene.props[0].positions[0].y), (0.0, 0.0), "{name}");
        scene.props[0].model().unwrap()
    };
    // For each triangle the three edge functions at the origin; zeros tell edge (one) from vertex (two).
    let zeros = |name: &str| {
        let model = vertices_and_triangles(name);
        let mut found = Vec::new();
        for triangle in &model.triangles {
            let [a, b, c] = triangle.map(|index| model.vertices[index as usize].position.map(f64::from));
            let edge = |p: [f64; 3], q: [f64; 3]| p[0] * q[1] - p[1] * q[0];
            let edges = [edge(a, b), edge(b, c), edge(c, a)];
            if edges.iter().all(|&value| value >= 0.0) {
                found.push(edges.iter().filter(|&&value| value == 0.0).count());
            }
        }
        found
    };
    assert_eq!(zeros("galaxy-axis"), [0]);
    assert_eq!(zeros("galaxy-axis-edge"), [1, 1]);
    assert_eq!(zeros("galaxy-axis-vertex"), [2; 6]);
}

#[test]
fn the_disk_of_a_scene_goes_before_the_configuration() {
    let mut config = GameConfig::default();
    config.disk.outer = 33.0;
    let text = "[disk]\ninner = 4.5\narcs = 570\n";
    let scene = Scene::from_toml(Path::new("a.toml"), text).unwrap();
    let disk = scene.disk(&config).unwrap();
    assert_eq!((disk.inner, disk.arcs, disk.outer), (4.5, 570, 33.0));
    assert!(Scene::from_toml(Path::new("a.toml"), "").unwrap().disk(&config).is_none());
}

#[test]
fn an_unknown_scene_names_what_is_known() {
    let error = load("nowhere").unwrap_err().to_string();
    assert!(error.contains("nowhere") && error.contains("parade") && error.contains("ring"), "{error}");
    assert!(load("no/such/file.toml").unwrap_err().to_string().contains("no/such/file.toml"));
}

#[test]
fn complaints_name_file_line_key_and_range() {
    for (text, parts) in [
        ("[camera]\nposition = [0.0, 0.0, 15.0]\nfov = 200\n", ["some/scene.toml:3:", "camera.fov", "1 to 170", "degrees"]),
        ("\n[camera]\nposition = [0.0, 0.0, 15.0]\nzoom = 3\n", ["some/scene.toml:4:", "camera.zoom", "unknown field", "fov"]),
        ("[camera]\nposition = [0.0, 0.0]\n", ["some/scene.toml:2:", "camera.position", "has 2 values", "3"]),
        ("[camera]\nposition = [0.0, 0.0, 15.0, 2.0]\n", ["some/scene.toml:2:", "camera.position", "has 4 values", "3"]),
        ("[[gate]]\nposition = [6.0, 0.0, 0.0, 1.0]\nradius = 0.5\n", ["some/scene.toml:2:", "gate[0].position", "has 4 values", "3"]),
        ("[camera]\nposition = [0.0, 0.0, 1e9]\n", ["some/scene.toml:2:", "camera.position", "10000", "r_s"]),
        ("[camera]\nposition = [nan, 0.0, 5.0]\n", ["some/scene.toml:2:", "camera.position", "finite", "NaN"]),
        ("[[prop]]\nmodel = \"sphere\"\nposition = [0.0, 0.0, 0.5]\n", ["some/scene.toml:3:", "prop[0].position", "0.5", "1.001"]),
        ("[[prop]]\nmodel = \"cube\"\n", ["some/scene.toml:2:", "prop[0].model", "\"cube\"", "lattice"]),
        (
            "[[prop]]\nmodel = \"square\"\nposition = [0,0,5]\n[[prop]]\nmodel = \"sphere\"\nposition = [0,0,5]\nsize = -1\n",
            ["some/scene.toml:7:", "prop[1].size", "-1", "0.0001"],
        ),
        (
            "[[prop]]\nmodel = \"sphere\"\nposition = [0,0,5]\ntriangles = 600000\n",
            ["some/scene.toml:4:", "prop[0].triangles", "600000", "500000"],
        ),
        (
            "[[prop]]\nmodel = \"lattice\"\nposition = [0,0,9]\ncount = [40, 40, 40]\ntriangles = 21\n",
            ["some/scene.toml:5:", "prop[0].triangles", "triangles, allowed 800000", "count"],
        ),
        ("[disk]\ninner = 3.0\nglow = 1\n", ["some/scene.toml:3:", "disk.glow", "unknown key", "turbulence"]),
        ("[disk]\narcs = 4\n", ["some/scene.toml:2:", "disk.arcs", "4 is out of range", "16 to 50000"]),
        ("[disk]\narcs = 570\nouter = 4.0\ninner = 6.5\n", ["some/scene.toml:4:", "disk.inner = 6.5", "less than", "disk.outer = 4"]),
        ("[disk]\ninner = \"three\"\n", ["some/scene.toml:2:", "disk.inner", "wrong type", "3 to 50 r_s"]),
        ("[planet]\norbit_radius = 20.0\nradius = 2.0\nday = 30.0\n", ["some/scene.toml:4:", "planet.day", "31.4", "r_s/c"]),
        ("[planet]\norbit_radius = 2.0\nradius = 0.5\n", ["some/scene.toml:2:", "planet.orbit_radius", "2", "r_s"]),
        ("[rules]\nhold_time = -1.0\n", ["some/scene.toml:2:", "rules.hold_time", "-1", "r_s/c"]),
        ("[sky]\nstars = 3\n", ["some/scene.toml:2:", "sky.stars", "true or false", "3"]),
        (
            "[[swarm]]\nname = \"a\"\ncount = 2\nradius = [9.0, 4.0]\n",
            ["some/scene.toml:4:", "swarm[0].radius", "[9, 4]", "from 1.5 to 1000000 r_s"],
        ),
        (
            "[[swarm]]\nname = \"a\"\ncount = 2\nradius = [1.5, 4.0]\n",
            ["some/scene.toml:4:", "swarm[0].radius", "above 1.5 r_s", "not 1.5"],
        ),
        ("[[swarm]]\nname = \"a\"\ncount = 2\nradius = [4.0]\n", ["some/scene.toml:4:", "swarm[0].radius", "has 1 value", "2"]),
        (
            "[[swarm]]\nname = \"a\"\ncount = 2\nradius = [4.0, 9.0]\ninclination = [-0.1, nan]\n",
            ["some/scene.toml:5:", "swarm[0].inclination", "[-0.1, NaN]", "from 0 to 3.14"],
        ),
        ("[[swarm]]\nname = \"a\"\ncount = 0\nradius = [4.0, 9.0]\n", ["some/scene.toml:3:", "swarm[0].count", "0 must be from 1", "1000"]),
        (
            "[[swarm]]\nname = \"a\"\ncount = 700\nradius = [4.0, 9.0]\n[[swarm]]\nname = \"b\"\ncount = 301\nradius = [4.0, 9.0]\n",
            ["some/scene.toml:7:", "swarm[1].count", "301 must be from 1 to 300", "1000"],
        ),
        (
            "[[swarm]]\nname = \"a\"\ncount = 2\nradius = [4.0, 9.0]\n[[swarm]]\nname = \"a\"\ncount = 2\nradius = [4.0, 9.0]\n",
            ["some/scene.toml:6:", "swarm[1].name", "\"a\"", "earlier swarm"],
        ),
        ("[[swarm]]\nname = \"\"\ncount = 2\nradius = [4.0, 9.0]\n", ["some/scene.toml:2:", "swarm[0].name", "1 to 50", ""]),
        (
            "[[ship]]\nname = \"a 2\"\norbit = { radius = 5.0 }\n[[swarm]]\nname = \"a\"\ncount = 2\nradius = [4.0, 9.0]\n",
            ["some/scene.toml:2:", "ship[0].name", "\"a 2\"", "taken by another ship"],
        ),
        ("[camera\n", ["some/scene.toml:1:", "", "", ""]),
        ("[camera]\nfollow = \"ghost\"\n", ["some/scene.toml:2:", "camera.follow", "ghost", "no ship"]),
    ] {
        let said = complaint(text);
        assert!(parts.iter().all(|part| said.contains(part)), "{text:?} gave {said:?}, lacking one of {parts:?}");
    }
}

/// All that is wrong with a disk is said at once, in the order of the file; what clashes only once the single values are right.
#[test]
fn complaints_about_a_disk_name_all_of_its_faults() {
    let said = complaint("[disk]\nouter = \"wide\"\nglow = 1\ninner = 6.5\narcs = 4\n");
    let lines: Vec<&str> = said.lines().collect();
    let wanted = [":2: disk.outer: ", ":3: disk.glow: unknown key", ":5: disk.arcs: 4 is out of range"];
    assert_eq!(lines.len(), wanted.len(), "{said}");
    assert!(lines.iter().zip(wanted).all(|(line, wanted)| line.contains(wanted)), "{said}");
    let said = complaint("[disk]\nouter = 4.0\ninner = 6.5\narcs = 4\n");
    assert!(said.contains("disk.arcs") && said.lines().count() == 1, "{said}");
}

#[test]
fn a_camera_without_momentum_is_at_rest() {
    let scene = Scene::from_toml(Path::new("a.toml"), "[camera]\nposition = [3.0, 0.0, 4.0]\n").unwrap();
    let Mount::Static(state) = scene.camera.mount else { panic!() };
    assert!(lensrunner::spacetime::matter::velocity(&state).length() < 1e-15);
    let inside = Scene::from_toml(Path::new("a.toml"), "[camera]\nposition = [0.3, 0.0, 0.4]\n").unwrap();
    let Mount::Falling(state) = inside.camera.mount else { panic!() };
    assert_eq!(state.momentum.length(), 0.0);
}

/// Every example of docs/scenes.md is a scene.
#[test]
fn the_documented_examples_are_scenes() {
    let text = include_str!("../../docs/scenes.md");
    let examples: Vec<&str> = text.split("```toml").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    assert!(examples.len() >= 5);
    for example in examples {
        if let Err(wrong) = lensrunner::scene::Scene::from_toml(std::path::Path::new("docs/scenes.md"), example) {
            panic!("{wrong}");
        }
    }
}

/// What cannot be a scene is refused, and what is said of it is short. That it takes less than ten seconds is for `fuzz/run` to see.
#[test]
fn scenes_out_of_all_bounds_are_refused() {
    let long = "x".repeat(1_000_000);
    let ships: String = (0..40_000).map(|k| format!("[[ship]]\nname = \"s{k}\"\norbit = {{ radius = 6.0 }}\n")).collect();
    for (text, parts) in [
        (format!("[camera]\n{long} = 3\n"), ["some/scene.toml:2:", "unknown field", "fov"]),
        (format!("[camera]\nfov = \"{long}\"\n"), ["some/scene.toml:2:", "camera.fov", "must be a number"]),
        (format!("[[prop]]\nmodel = \"{long}\"\n"), ["some/scene.toml:2:", "prop[0].model", "lattice"]),
        (format!("[camera]\nfollow = \"{long}\"\n"), ["some/scene.toml:2:", "camera.follow", "no ship"]),
        (format!("[camera]\nposition = {}", "[".repeat(500_000)), ["some/scene.toml:2:", "allowed are 32 levels", ""]),
        (ships, ["some/scene.toml:3001:", "40000 ships, allowed are 1000", ""]),
    ] {
        let said = complaint(&text);
        assert!(
            parts.iter().all(|part| said.contains(part)) && said.len() < 2000,
            "{} bytes: {said}, lacking one of {parts:?}",
            said.len()
        );
    }
    // Each by itself is allowed; together they are more than memory holds, or take minutes.
    let lattice = "[[prop]]\nmodel = \"lattice\"\ncount = [200, 100, 2]\ntriangles = 20\n";
    let cleared = lattice.replace("triangles = 20", "clearance = 10000.0");
    let models = |length: usize| -> String {
        (0..200).map(|k| format!("[[prop]]\nmodel = \"{k:0length$}.glb\"\nposition = [0.0, 0.0, 9.0]\n")).collect()
    };
    for (text, parts) in [
        (lattice.repeat(2_000), ["some/scene.toml:8:", "prop[1].triangles", "up to here the scene has 1600000 triangles, allowed 800000"]),
        (cleared.repeat(2_000), ["some/scene.toml:23:", "prop[5].count", "all lattices have 240000 spheres, allowed 200000"]),
        (models(4), ["some/scene.toml:302:", "prop[100].model", "names 101 models, allowed 100"]),
        (models(2000), ["some/scene.toml:2:", "prop[0].model", "2004 bytes, allowed 1 to 1024"]),
    ] {
        let said = complaint(&text);
        assert!(parts.iter().all(|part| said.contains(part)) && said.len() < 400, "{said}, lacking one of {parts:?}");
    }
    let folder = crate::support::Folder::new();
    let file = folder.path().join("a.toml");
    std::fs::File::create(&file).and_then(|file| file.set_len(12 << 30)).unwrap();
    let said = load(&file.to_string_lossy()).unwrap_err().to_string();
    assert!(said.contains("a.toml: it has 12884901888 bytes, allowed are at most 4194304"), "{said}");
    std::fs::write(&file, b"[camera]\n# \xff\n").unwrap();
    let said = load(&file.to_string_lossy()).unwrap_err().to_string();
    assert!(said.contains("a.toml: line 2 is no text in UTF-8"), "{said}");
}
