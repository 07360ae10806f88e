use lensrunner::render::shot::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let r = Request { scene: &a[1], size: [640, 360], at: a.get(3).map_or(0.0, |t| t.parse().unwrap()), layers: false };
    match shot(&r, &Default::default()) { Ok(p) => p.write(std::path::Path::new(&a[2])).unwrap(), Err(e) => eprintln!("{e}") }
}
