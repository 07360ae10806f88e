//! The list of products, in the order in which they are made: charts, then tables, then pictures.

use super::{Product, Program, Run};

/// A call of the laboratory.
const fn lab(arguments: &'static str) -> Run {
    Run { program: Program::Lab, arguments, printed: None }
}

/// A call of the game.
const fn game(arguments: &'static str) -> Run {
    Run { program: Program::Game, arguments, printed: None }
}

/// A call of the laboratory that prints its table, which the file `printed` keeps.
const fn table(arguments: &'static str, printed: &'static str) -> Run {
    Run { program: Program::Lab, arguments, printed: Some(printed) }
}

/// What is drawn by the game.
const DRAWN: &[&str] = &["src/render", "shaders", "src/scene", "src/lensing", "src/spacetime", "tables/default.lut", "game.toml"];
/// What flies.
const FLOWN: &[&str] = &["src/sim", "src/scene", "src/spacetime", "game.toml"];
/// What judges.
const JUDGED: &[&str] = &["src/judge", "lab/src/compare", "lab/src/contestant.rs", "lab/src/flip.rs"];

/// A picture of the game: `picture!(name, folder, scene file, further arguments, arguments in small)`.
macro_rules! picture {
    ($name:literal, $folder:literal, $scene:literal, $size:literal $(, $more:literal)?) => {
        Product {
            name: $name,
            runs: &[game(concat!("shot --scene ", $scene, " --size ", $size, $(" ", $more,)? " -o {}/", $name, ".png"))],
            quick: &[game(concat!("shot --scene ", $scene, " --size 320x180", $(" ", $more,)? " -o {}/", $name, ".png"))],
            folder: $folder,
            files: &[concat!($name, ".png")],
            grows: false,
            sources: &[DRAWN, &[concat!("assets/*/", $scene, ".toml")]],
            seconds: [5.0, 4.0],
        }
    };
}

/// A picture of the game beside the judge's: `verdict!(scene, further arguments)`.
macro_rules! verdict {
    ($scene:literal $(, $more:literal)?) => {
        Product {
            name: concat!("verdict-", $scene),
            runs: &[lab(concat!("compare --scene ", $scene, " --size 400x225", $(" ", $more,)? " -o {}/", $scene, ".png"))],
            quick: &[lab(concat!("compare --scene ", $scene, " --size 160x90 --samples 1", $(" ", $more,)? " -o {}/", $scene, ".png"))],
            folder: "verdict",
            files: &[concat!($scene, ".png")],
            grows: false,
            sources: &[DRAWN, JUDGED, &[concat!("assets/*/", $scene, ".toml")]],
            seconds: [60.0, 6.0],
        }
    };
}

/// Every chart, table and picture of the documents.
pub const PRODUCTS: &[Product] = &[
    Product {
        name: "projection",
        runs: &[lab("chart projection --points 300000 -o {}")],
        quick: &[lab("chart projection --points 2000 -o {}")],
        folder: "",
        files: &[
            "projection.csv",
            "projection-gpu.csv",
            "projection-maps.csv",
            "projection-paper1.csv",
            "projection.svg",
            "projection.png",
            "projection-maps.png",
        ],
        grows: false,
        sources: &[&[
            "src/lensing",
            "src/spacetime",
            "shaders/lensing",
            "shaders/method",
            "tables/default.lut",
            "lab/src/projection",
            ":(exclude)lab/src/projection/draw.rs",
        ]],
        seconds: [1200.0, 90.0],
    },
    Product {
        name: "disk",
        runs: &[lab("chart disk --rounds 5 --steps 12 --flight 200 -o {}")],
        quick: &[lab("chart disk --rounds 1 --steps 2 --flight 4 --size 320x180 --error-size 96x54 -o {}")],
        folder: "disk",
        files: &[
            "disk-alone.csv",
            "disk-chase.csv",
            "disk-summary.csv",
            "disk-places.csv",
            "disk-flight.csv",
            "disk-flight-summary.csv",
            "disk.svg",
            "disk.png",
        ],
        grows: false,
        sources: &[DRAWN, &["lab/src/disk", ":(exclude)lab/src/disk/draw.rs", "lab/src/flip.rs"]],
        seconds: [900.0, 60.0],
    },
    Product {
        name: "aurora",
        runs: &[lab("chart aurora --electrons 1000,2000,4000 --radii 0.75,1.5,3 --size 320x180 --repeats 3 -o {}")],
        quick: &[lab("chart aurora --auroras 1 --electrons 500,1000 --radii 1.5 --size 160x90 --repeats 1 -o {}")],
        folder: "",
        files: &["aurora.csv", "aurora.svg", "aurora.png"],
        grows: false,
        sources: &[&[
            "lab/src/aurora",
            ":(exclude)lab/src/aurora/chart.rs",
            "lab/src/aurora_race.rs",
            "lab/shaders/aurora",
            "src/scene/aurora",
            "src/lensing",
            "src/spacetime",
        ]],
        seconds: [1200.0, 20.0],
    },
    Product {
        name: "bvh",
        runs: &[lab("chart bvh --rounds 5 -o {}")],
        quick: &[lab("chart bvh --rounds 1 --scenes balls4C -o {}")],
        folder: "",
        files: &["bvh.csv", "bvh.svg", "bvh.png"],
        grows: false,
        sources: &[&["lab/src/straight", "lab/src/bvh", ":(exclude)lab/src/bvh/draw.rs"]],
        seconds: [1500.0, 40.0],
    },
    Product {
        name: "trace",
        runs: &[lab("chart trace -o {}")],
        quick: &[lab("chart trace --pixels 16 -o {}")],
        folder: "",
        files: &["trace.csv", "trace.svg", "trace.png"],
        grows: false,
        sources: &[&["src/judge", "src/spacetime", "src/scene/disk/radial.rs", "lab/src/thin_disk", ":(exclude)lab/src/thin_disk/draw.rs"]],
        seconds: [60.0, 10.0],
    },
    Product {
        name: "flight",
        runs: &[lab("chart flight -o {}")],
        quick: &[lab("chart flight --rounds 1 --evaluations 20000 -o {}")],
        folder: "",
        files: &["flight.csv", "flight-limits.csv", "flight.svg", "flight.png"],
        grows: false,
        sources: &[&["src/spacetime", "lab/src/flight", ":(exclude)lab/src/flight/draw.rs"]],
        seconds: [70.0, 5.0],
    },
    Product {
        name: "tessellation",
        runs: &[lab("chart tessellation -o {}")],
        quick: &[lab("chart tessellation --scene ring --size 160x90 --bounds 0.5,2 --rounds 1 -o {}")],
        folder: "",
        files: &["tessellation.csv", "tessellation.svg", "tessellation.png"],
        grows: false,
        sources: &[DRAWN, JUDGED, &["lab/src/tessellation", ":(exclude)lab/src/tessellation/draw.rs"]],
        seconds: [400.0, 15.0],
    },
    Product {
        name: "verdict",
        runs: &[lab("compare --scene all --size 1280x720 --samples 1 -o {}")],
        quick: &[lab("compare --scene ring --size 160x90 --samples 1 --table {}/verdict.csv -o {}/ring.png")],
        folder: "verdict",
        files: &["verdict.csv", "verdict.md"],
        grows: false,
        sources: &[DRAWN, JUDGED, FLOWN, &["assets/scenes", "assets/models"]],
        seconds: [1800.0, 6.0],
    },
    Product {
        name: "scenes",
        runs: &[
            lab("compare --random 500 --seed 2026112505 --whole --collect {}/scenes.csv -o {}/random"),
            lab("compare --flight chase --seeds 20 --moments 30 --whole --collect {}/scenes.csv -o {}/flight"),
        ],
        quick: &[lab("compare --random 4 --seed 1 --whole --collect {}/scenes.csv -o {}/random")],
        folder: "verdict",
        files: &["scenes.csv", "scenes.md"],
        grows: true,
        sources: &[DRAWN, JUDGED, FLOWN],
        seconds: [1600.0, 10.0],
    },
    Product {
        name: "balance",
        runs: &[game("balance --seeds 50 -o {}")],
        quick: &[game("balance --seeds 1 --missions 01-training -o {}")],
        folder: "balance",
        files: &["balance.csv", "balance.md"],
        grows: false,
        sources: &[FLOWN, &["assets/missions"]],
        seconds: [600.0, 5.0],
    },
    Product {
        name: "quarry",
        runs: &[
            table("chart quarry --scene 02-first-pursuit --seeds 40", "quarry-02-first-pursuit.md"),
            table("chart quarry --scene 03-through-the-disk --seeds 40", "quarry-03-through-the-disk.md"),
            table("chart quarry --scene 04-the-ghost --seeds 40", "quarry-04-the-ghost.md"),
        ],
        quick: &[
            table("chart quarry --scene 02-first-pursuit --seeds 1", "quarry-02-first-pursuit.md"),
            table("chart quarry --scene 03-through-the-disk --seeds 1", "quarry-03-through-the-disk.md"),
            table("chart quarry --scene 04-the-ghost --seeds 1", "quarry-04-the-ghost.md"),
        ],
        folder: "tables",
        files: &["quarry-02-first-pursuit.md", "quarry-03-through-the-disk.md", "quarry-04-the-ghost.md"],
        grows: false,
        sources: &[FLOWN, &["lab/src/quarry.rs", "assets/missions"]],
        seconds: [300.0, 15.0],
    },
    Product {
        name: "steps",
        runs: &[table("chart steps", "steps.md")],
        quick: &[table("chart steps --steps 1000", "steps.md")],
        folder: "tables",
        files: &["steps.md"],
        grows: false,
        sources: &[FLOWN, &["lab/src/steps.rs"]],
        seconds: [30.0, 3.0],
    },
    Product {
        name: "frame",
        runs: &[lab("chart frame --scene ring,galaxy,parade,disk,chase,aurora-orbit --frames 8 --flight 24 -o {}")],
        quick: &[lab("chart frame --scene disk --frames 2 --size 320x180 --flight 2 -o {}")],
        folder: "lab",
        files: &["frame.csv", "frame-flight.csv"],
        grows: false,
        sources: &[DRAWN, &["lab/src/frame_times"]],
        seconds: [400.0, 20.0],
    },
    Product {
        name: "dial",
        runs: &[lab("chart dial --check --moments 200 --size 640x360 -o {}")],
        quick: &[lab("chart dial --check --moments 2 --size 160x90 -o {}")],
        folder: "lab",
        files: &["dial-check.csv", "dial.svg", "dial.png"],
        grows: false,
        sources: &[DRAWN, &["lab/src/dial", "tables/quality.csv"]],
        seconds: [900.0, 15.0],
    },
    Product {
        name: "dial-levels",
        runs: &[lab("chart dial --levels --moments 6 --size 640x360 -o {}")],
        quick: &[lab("chart dial --levels --moments 1 --size 160x90 -o {}")],
        folder: "lab",
        files: &["dial-levels.csv", "dial-levels.svg", "dial-levels.png"],
        grows: false,
        sources: &[DRAWN, &["lab/src/dial", "tables/quality.csv"]],
        seconds: [120.0, 15.0],
    },
    Product {
        name: "dial-moving",
        runs: &[lab("chart dial --moving --moments 240 --size 640x360 -o {}")],
        quick: &[lab("chart dial --moving --moments 12 --size 160x90 -o {}")],
        folder: "lab",
        files: &["dial-moving.csv"],
        grows: false,
        sources: &[DRAWN, &["lab/src/dial", "tables/quality.csv"]],
        seconds: [600.0, 15.0],
    },
    Product {
        name: "stability",
        runs: &[lab("stability -o {}")],
        quick: &[lab("stability --quick -o {}")],
        folder: "lab",
        files: &["stability.csv", "stability.md"],
        grows: false,
        sources: &[
            DRAWN,
            &[
                "lab/src/stability",
                "lab/src/flight",
                "lab/src/projection/methods",
                "lab/src/tessellation",
                "lab/src/straight",
                "lab/scenes",
            ],
        ],
        seconds: [600.0, 60.0],
    },
    Product {
        name: "drivers",
        runs: &[lab("chart drivers --driver /usr/lib/chromium/vk_swiftshader_icd.json -o {}")],
        // It needs a second driver.
        quick: &[],
        folder: "lab",
        files: &["drivers.csv", "drivers.png"],
        grows: false,
        sources: &[DRAWN, &["lab/src/drivers"]],
        seconds: [120.0, 0.0],
    },
    Product {
        name: "card",
        // Measured on a graphics card, by the commands of docs/lab/card.md: another machine would put other figures there.
        runs: &[],
        quick: &[],
        folder: "lab/card",
        files: &["dial-check.csv", "drivers-nvidia-h100.csv", "drivers-nvidia-h100.png", "frame-flight.csv", "frame.csv"],
        grows: false,
        sources: &[DRAWN, &["lab/src/drivers", "lab/src/frame_times", "lab/src/dial", "tables/quality.csv"]],
        seconds: [0.0, 0.0],
    },
    Product {
        name: "hands",
        runs: &[lab("chart hands -o {}")],
        quick: &[lab("chart hands --scenes 06-the-long-shot --frames 20 --size 160x90 -o {}")],
        folder: "lab",
        files: &["hands.csv"],
        grows: false,
        sources: &[DRAWN, FLOWN, &["lab/src/hands_frames.rs", "lab/src/compare/flight"]],
        seconds: [1200.0, 30.0],
    },
    Product {
        name: "motion",
        runs: &[lab("chart motion -o {}")],
        quick: &[lab("chart motion --moments 5 -o {}")],
        folder: "lab",
        files: &["motion.csv", "motion.png", "motion.svg"],
        grows: false,
        sources: &[FLOWN, &["src/render/instances", "lab/src/motion"]],
        seconds: [20.0, 5.0],
    },
    Product {
        name: "soak",
        runs: &[lab("chart soak -o {}")],
        quick: &[lab("chart soak --steps 2000 --frames 20 -o {}")],
        folder: "lab",
        files: &["soak.csv"],
        grows: false,
        sources: &[DRAWN, FLOWN, &["lab/src/soak.rs"]],
        seconds: [1500.0, 15.0],
    },
    Product {
        name: "window",
        runs: &[lab("chart window --size 1280x720,1920x1080 --frames 300 --rounds 2 -o {}")],
        // It needs a display.
        quick: &[],
        folder: "lab",
        files: &["window.csv", "window-1280x720.png", "window-1920x1080.png"],
        grows: false,
        sources: &[DRAWN, &["lab/src/window_rates", "src/play", "tables/quality.csv"]],
        seconds: [240.0, 0.0],
    },
    Product {
        name: "frame-rationed",
        runs: &[
            table("chart frame --scene aurora-side,aurora-below,aurora-orbit,aurora-lensed,chase,disk --frames 12", "frames.txt"),
            table(
                "chart frame --scene aurora-side,aurora-below,aurora-orbit,aurora-lensed,chase --frames 12 --rationed",
                "frames-rationed.txt",
            ),
        ],
        quick: &[
            table("chart frame --scene disk --frames 2 --size 320x180", "frames.txt"),
            table("chart frame --scene aurora-side --frames 2 --size 320x180 --rationed", "frames-rationed.txt"),
        ],
        folder: "tables",
        files: &["frames.txt", "frames-rationed.txt"],
        grows: false,
        sources: &[DRAWN, &["lab/src/frame_times"]],
        seconds: [180.0, 15.0],
    },
    picture!("title", "", "chase", "720x405"),
    picture!("parade", "", "parade", "640x360"),
    picture!("ring", "", "ring", "640x360"),
    picture!("galaxy-axis", "", "galaxy-axis", "640x360"),
    picture!("plunge", "", "plunge", "640x360", "--at 1.2"),
    picture!("missions", "", "07-arrive-young", "640x360"),
    picture!("aurora-below", "", "aurora-below", "640x360"),
    picture!("aurora-side", "", "aurora-side", "640x360"),
    picture!("aurora-orbit", "", "aurora-orbit", "640x360"),
    picture!("aurora-lensed", "", "aurora-lensed", "640x360"),
    picture!("disk-0", "disk", "disk-0", "640x360"),
    picture!("disk-30", "disk", "disk-30", "640x360"),
    picture!("disk-60", "disk", "disk-60", "640x360"),
    picture!("disk-80", "disk", "disk-80", "640x360"),
    picture!("disk-inner", "disk", "disk-inner", "640x360"),
    picture!("disk-skim", "disk", "disk-skim", "640x360"),
    picture!("disk-film", "disk", "disk-80", "640x360", "--config lab/film.toml"),
    verdict!("chase", "--at 20"),
    verdict!("ring"),
    verdict!("parade"),
    verdict!("disk"),
    Product {
        name: "flight-sheet",
        runs: &[game("play --headless --size 640x360 --record {}")],
        quick: &[game("play --headless --size 160x90 --frames 16 --record {}")],
        folder: "",
        files: &["contact-sheet.png"],
        grows: false,
        sources: &[DRAWN, FLOWN, &["src/play", "assets/scenes/chase.toml"]],
        seconds: [600.0, 15.0],
    },
    Product {
        name: "screens",
        runs: &[game("screens -o {}/screens")],
        quick: &[game("screens --language en --size 640x360 --only title -o {}/screens")],
        folder: "",
        files: &["screens/"],
        grows: false,
        sources: &[DRAWN, FLOWN, &["src/play", "assets"]],
        seconds: [600.0, 20.0],
    },
];
