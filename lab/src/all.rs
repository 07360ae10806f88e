//! `all` and `status` on the command line: the products of the documents, made anew and looked over.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use lensrunner_lab::products::made::{Made, ProductsError, Record, Standing, made, standing};
use lensrunner_lab::products::make::{MakeRequest, duration, make};
use lensrunner_lab::products::{DOCUMENTS, Product, products};
use lensrunner_lab::say::say;

use crate::fail;

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

fn table() -> Result<Vec<Product>, ProductsError> {
    products().map_err(|error| ProductsError::Toml("table.toml".into(), error.to_string()))
}

/// Makes them.
pub fn all(request: MakeRequest) -> ExitCode {
    let request = MakeRequest { root: PathBuf::from("."), ..request };
    let programs = std::env::current_exe().map_err(|error| ProductsError::Io("this program".into(), error));
    match programs.and_then(|programs| make(&table()?, &request, &programs)) {
        Ok(failed) if failed.is_empty() => ExitCode::SUCCESS,
        Ok(failed) => fail(&format!("not made: {}", failed.join(", ")), 1),
        Err(error) => fail(&error, 2),
    }
}

/// Looks them over.
pub fn status(args: &StatusArgs) -> ExitCode {
    let (record, products) = match Record::load(&args.output).and_then(|record| Ok((record, table()?))) {
        Ok(both) => both,
        Err(error) => return fail(&error, 2),
    };
    let (root, mut stale) = (Path::new("."), 0);
    for product in &products {
        let made = made(root, &args.output, product, &record);
        let stands = made.as_ref().map_or(Standing::Missing, |made| standing(root, &made.on.commit, &product.sources));
        stale += usize::from(stands != Standing::Fresh);
        if !args.stale || stands != Standing::Fresh {
            say(format_args!("{}: {stands}{}", product.name, made.as_ref().map(provenance_text).unwrap_or_default()));
        }
    }
    say(format_args!("{} products, {stale} stale or missing", products.len()));
    ExitCode::SUCCESS
}

/// How a product came to be.
fn provenance_text(made: &Made) -> String {
    let on = [&made.on.commit, &made.on.date, &made.on.processor, &made.on.adapter];
    let on: Vec<&str> = on.into_iter().map(String::as_str).filter(|text| !text.is_empty()).collect();
    let how = if made.guessed { " (committed; how it was made is not recorded)" } else { "" };
    let took = if made.seconds > 0.0 { format!(" · {}", duration(made.seconds)) } else { String::new() };
    let commands: String = made.commands.iter().map(|command| format!("\n  {command}")).collect();
    format!("\n  {}{how}{took}{commands}", on.join(" · "))
}
