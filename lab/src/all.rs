//! `all` and `status` on the command line: the products of the documents, made anew and looked over.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use lensrunner::render::Gpu;
use lensrunner_lab::products::made::{Record, made};
use lensrunner_lab::products::make::{MakeRequest, duration, make};
use lensrunner_lab::products::{DOCUMENTS, Made, PRODUCTS, Standing, standing};

use crate::fail;

/// Makes every chart, table and picture of the documents anew. What was made by the same command from the same sources is left, so a run
/// that was broken off goes on where it was.
#[derive(Args)]
pub struct AllArgs {
    /// Everything in small, in less than ten minutes on two cores, into a folder of its own.
    #[arg(long)]
    quick: bool,
    /// Only these products, separated by commas.
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    only: Vec<String>,
    /// Also what is up to date.
    #[arg(long)]
    again: bool,
    /// The folder [default: docs, with --quick out/quick].
    #[arg(short, value_name = "DIR")]
    output: Option<PathBuf>,
}

/// Says of each product by which commit, on what machine and by what command it was made, and whether the code has changed since.
#[derive(Args)]
pub struct StatusArgs {
    /// Only what is stale or missing.
    #[arg(long)]
    stale: bool,
    /// The folder of the products.
    #[arg(short, value_name = "DIR", default_value = DOCUMENTS)]
    output: PathBuf,
}

/// Makes them.
pub fn all(args: AllArgs) -> ExitCode {
    let target = std::env::current_exe().ok().and_then(|program| Some(program.parent()?.parent()?.to_owned()));
    let folder = args.output.unwrap_or_else(|| PathBuf::from(if args.quick { "out/quick" } else { DOCUMENTS }));
    let request = MakeRequest {
        root: PathBuf::from("."),
        folder,
        workshop: PathBuf::from("out/workshop"),
        quick: args.quick,
        again: args.again,
        only: args.only,
        times: target.unwrap_or_else(|| PathBuf::from("out")).join("lab-times.toml"),
        adapter: Gpu::headless().map(|gpu| gpu.adapter.name.clone()).unwrap_or_default(),
    };
    match make(PRODUCTS, &request) {
        Ok(failed) if failed.is_empty() => ExitCode::SUCCESS,
        Ok(failed) => fail(&format!("not made: {}", failed.join(", ")), 1),
        Err(error) => fail(&error, 2),
    }
}

/// Looks them over.
pub fn status(args: &StatusArgs) -> ExitCode {
    let record = match Record::load(&args.output) {
        Ok(record) => record,
        Err(error) => return fail(&error, 2),
    };
    let (root, mut stale, mut text) = (Path::new("."), 0, String::new());
    for product in PRODUCTS {
        let made = made(root, &args.output, product, &record);
        let stands = made.as_ref().map_or(Standing::Missing, |made| standing(root, &made.on.commit, product.all_sources()));
        stale += usize::from(stands != Standing::Fresh);
        if args.stale && stands == Standing::Fresh {
            continue;
        }
        text += &format!("{}: {stands}\n", product.name);
        text += &made.as_ref().map(told).unwrap_or_default();
    }
    text += &format!("{} products, {stale} stale or missing\n", PRODUCTS.len());
    // What nobody reads any more, as behind `| head`, is dropped.
    let _ = std::io::stdout().write_all(text.as_bytes());
    ExitCode::SUCCESS
}

/// How a product came to be.
fn told(made: &Made) -> String {
    let on = [&made.on.commit, &made.on.date, &made.on.processor, &made.on.adapter];
    let on: Vec<&str> = on.into_iter().map(String::as_str).filter(|text| !text.is_empty()).collect();
    let how = if made.told { "" } else { " (committed; how it was made is not recorded)" };
    let took = if made.seconds > 0.0 { format!(" · {}", duration(made.seconds)) } else { String::new() };
    let commands: String = made.commands.iter().map(|command| format!("  {command}\n")).collect();
    format!("  {}{how}{took}\n{commands}", on.join(" · "))
}
