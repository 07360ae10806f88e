//! The `project` table: its numbers, its form, and what it says about wrong input.

use lensrunner::lensing::project::{AngleFrame, ProjectRequest, method, project, run, significant};
use lensrunner::spacetime::light::{Branch, Order};
use std::cell::RefCell;
use std::io::{Read, Write};
use std::process::{Command, Output, Stdio};

const PRIMARY: ProjectRequest = ProjectRequest { order: Order::ALL[0], frame: AngleFrame::Static, branch: Branch::Plus };

/// The answer's rows, split into fields.
fn rows(input: &str, request: ProjectRequest) -> Vec<Vec<String>> {
    let exact = method("exact").expect("it exists");
    let output = project(input, exact.as_ref(), request).expect("good input");
    let mut lines = output.lines();
    assert_eq!(lines.next(), Some("r,phi,L,psi,delay,redshift"));
    lines.map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

fn complaint(input: &str) -> String {
    let exact = method("exact").expect("it exists");
    project(input, exact.as_ref(), PRIMARY).expect_err("wrong input").to_string()
}

#[test]
fn the_documented_example() {
    let rows = rows("r,phi,L\n20,1.5707963267948966,10\n", PRIMARY);
    let expected = "20,1.5707963267948966,10,1.92414872116,20.8593948055,1.02740233383";
    assert_eq!(rows[0].join(","), expected);
}

#[test]
fn order_of_rows_and_spelling_of_fields_are_kept() {
    let input = "r,phi,L\r\n 2e1 ,1.50,10.000\r\n5,0.1,7\r\n20,1.50,1e1\r\n\r\n";
    let rows = rows(input, PRIMARY);
    assert_eq!(rows.len(), 3);
    assert_eq!(rows[0][..3], ["2e1", "1.50", "10.000"]);
    assert_eq!(rows[1][..3], ["5", "0.1", "7"]);
    assert_eq!(rows[0][3..], rows[2][3..]);
}

/// Spreadsheets put a byte order mark before the header.
#[test]
fn a_byte_order_mark_is_passed_over() {
    let row = "r,phi,L\n20,1.5,10\n";
    assert_eq!(rows(&format!("\u{feff}{row}"), PRIMARY), rows(row, PRIMARY));
    assert!(complaint(&format!("\u{feff}\u{feff}{row}")).starts_with("line 1: "), "only one");
}

#[test]
fn fields_that_do_not_exist_are_empty() {
    let at = |line: &str, request| rows(&format!("r,phi,L\n{line}"), request).remove(0)[3..].to_vec();
    let rain = ProjectRequest { frame: AngleFrame::Rain, ..PRIMARY };
    let filled = |fields: &[String]| fields.iter().map(|field| !field.is_empty()).collect::<Vec<_>>();
    assert_eq!(filled(&at("0.5,1,5", PRIMARY)), [false, false, false], "inside from outside");
    assert_eq!(filled(&at("0.3,1,0.5", rain)), [false, false, false], "deeper than the camera");
    assert_eq!(filled(&at("5,1,0.5", PRIMARY)), [false, true, false], "no static camera inside");
    assert_eq!(filled(&at("5,1,0.5", rain)), [true, true, false], "no static redshift inside");
    assert_eq!(filled(&at("5,1,1", PRIMARY)), [false, true, false], "on the horizon");
    assert_eq!(filled(&at("5,1,2", rain)), [true, true, true]);
    // Inside, only the first order; the branch matters only with both ends inside.
    let minus = ProjectRequest { branch: Branch::Minus, ..rain };
    assert_eq!(at("5,1,0.5", minus), at("5,1,0.5", rain));
    assert_ne!(at("0.8,0.2,0.5", minus), at("0.8,0.2,0.5", rain));
    let second = ProjectRequest { order: Order::ALL[1], ..rain };
    assert_eq!(filled(&at("0.8,0.2,0.5", second)), [false, false, false]);
}

#[test]
fn the_axis_is_stepped_off() {
    let input = "r,phi,L\n20,0,10\n20,1e-9,10\n20,3.141592653589793,10\n20,3.1415926526,10\n";
    let rows = rows(input, PRIMARY);
    assert_eq!(rows[0][3..], rows[1][3..]);
    let close = |a: &str, b: &str| {
        let (a, b): (f64, f64) = (a.parse().expect("a number"), b.parse().expect("a number"));
        (a - b).abs() < 1e-9
    };
    assert!(close(&rows[2][3], "2.6989684589193") && close(&rows[3][3], "2.6989684589193"));
}

#[test]
fn wrong_input_names_its_line() {
    assert!(complaint("").contains("line 1"));
    assert!(complaint("20,1,10\n").contains("line 1"));
    assert!(complaint("r,phi\n20,1\n").contains("line 1"));
    for (row, what) in [
        ("20,x,10", "phi"),
        ("20,1", "3 fields"),
        ("20,1,10,4", "3 fields"),
        ("NaN,1,10", "r = NaN"),
        ("20,1,inf", "L = inf"),
        ("0,1,10", "r = 0"),
        ("20,1,-1", "L = -1"),
        ("20,-0.1,10", "phi = -0.1"),
        ("20,3.15,10", "0 to π"),
        ("", "3 fields"),
    ] {
        let message = complaint(&format!("r,phi,L\n20,1,10\n{row}\n20,1,10\n"));
        assert!(message.contains("line 3") && message.contains(what), "{row:?}: {message}");
    }
    assert!(method("exakt").err().expect("unknown").to_string().contains("exact"));
}

#[test]
fn twelve_significant_digits() {
    assert_eq!(significant(1.0), "1.00000000000");
    assert_eq!(significant(123456.789012345), "123456.789012");
    assert_eq!(significant(0.000123456789012345), "0.000123456789012");
    assert_eq!(significant(9.9999999999999), "10.0000000000");
    assert_eq!(significant(1.5e20), "1.50000000000e20");
    assert_eq!(significant(-2.5e-9), "-2.50000000000e-9");
    assert_eq!(significant(f64::INFINITY), "");
}

/// What comes in pieces, and what has been answered by the time that each piece is asked for.
struct Pieces<'a> {
    left: Vec<&'a [u8]>,
    written: &'a RefCell<Vec<u8>>,
    seen: Vec<String>,
}

impl Read for Pieces<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        self.seen.push(String::from_utf8(self.written.borrow().clone()).expect("text"));
        if self.left.is_empty() {
            return Ok(0);
        }
        let piece = self.left.remove(0);
        buffer[..piece.len()].copy_from_slice(piece);
        Ok(piece.len())
    }
}

struct Answers<'a>(&'a RefCell<Vec<u8>>);

impl Write for Answers<'_> {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.borrow_mut().write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

/// What is written for pieces that come one after the other, by the time that each is asked for, and what is wrong with them.
fn answered(pieces: &[&[u8]]) -> (Vec<String>, Option<String>) {
    let written = RefCell::new(Vec::new());
    let mut input = Pieces { left: pieces.to_vec(), written: &written, seen: Vec::new() };
    let wrong = run(&mut input, &mut Answers(&written), method("exact").expect("it exists").as_ref(), PRIMARY).err();
    input.seen.push(String::from_utf8(written.borrow().clone()).expect("text"));
    (input.seen, wrong.map(|wrong| wrong.to_string()))
}

#[test]
fn rows_are_answered_as_they_come() {
    let whole = "r,phi,L\n20,1,10\n20,2,10\n20,3,10\n";
    let answer = project(whole, method("exact").expect("it exists").as_ref(), PRIMARY).expect("good input");
    let up_to = |lines: usize| answer.lines().take(lines).map(|line| format!("{line}\n")).collect::<String>();
    let (seen, wrong) = answered(&[b"r,phi,L\n20,", b"1,10\n20,2,10\n20,3", b",10"]);
    assert_eq!((seen, wrong), (vec![String::new(), up_to(1), up_to(3), up_to(3), up_to(4)], None));
    // A letter of two bytes in two pieces; blank lines that turn out not to be the end.
    let (seen, wrong) = answered(&["\u{feff}r,phi,L\n20,1,10\n".as_bytes(), b"20,\xc3", b"\xa4,10\n"]);
    assert_eq!((seen.last(), wrong.as_deref()), (Some(&up_to(2)), Some("line 3: phi = \"ä\" is not a number")));
    let (seen, wrong) = answered(&[b"r,phi,L\n20,1,10\n\n", b" \n20,2,10\n"]);
    assert_eq!(seen.last(), Some(&up_to(2)));
    assert_eq!(wrong.as_deref(), Some("line 3: expected 3 fields (r,phi,L), found 0"));
    // Without an end: refused before it fills memory.
    let endless = [b'9'; 1 << 19];
    let (_, wrong) = answered(&[b"r,phi,L\n20,1,10\n", &endless, &endless, &endless, &endless, &endless, &endless]);
    assert_eq!(wrong.as_deref(), Some("line 3: more than 1048576 bytes, allowed are 1048576"));
}

fn command_line(arguments: &[&str], input: &[u8]) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_lensrunner"))
        .arg("project")
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    // It may end before it has read everything.
    let _ = child.stdin.take().expect("piped").write_all(input);
    child.wait_with_output().expect("the program ends")
}

#[test]
fn the_command_line_answers_and_refuses() {
    let good = command_line(&["--frame", "rain", "--order", "2"], b"r,phi,L\n20,1,10\n");
    assert!(good.status.success() && good.stdout.starts_with(b"r,phi,L,psi,delay,redshift\n20,1,10,"));
    for (arguments, input) in [
        (&[][..], &b"r,phi,L\n20,1,10\n20,y,10\n"[..]),
        (&[], b"r,phi,L\n20,1,10\n20,\xff,10\n"),
        (&["--method", "exakt"], b"r,phi,L\n"),
        (&["--order", "4"], b"r,phi,L\n"),
        (&["--frame", "ship"], b"r,phi,L\n"),
    ] {
        let refused = command_line(arguments, input);
        assert_eq!(refused.status.code(), Some(2), "{arguments:?}");
        assert!(refused.stdout.is_empty() && !refused.stderr.is_empty());
    }
    let long = command_line(&[], format!("r,phi,L\n20,1,{}\n", "9".repeat(1_000_000)).as_bytes());
    let said = String::from_utf8_lossy(&long.stderr).into_owned();
    assert!(long.status.code() == Some(2) && said.contains("line 2: L = 999") && said.len() < 400, "{said}");
    let named = command_line(&[], b"r,phi,L\n20,1,10\n20,\xff,10\n");
    assert!(String::from_utf8_lossy(&named.stderr).contains("line 3"));
}

#[test]
fn every_method_is_named_where_it_is_asked_for() {
    use lensrunner::lensing::methods::{self, NAMES};
    let run = |arguments: &[&str]| Command::new(env!("CARGO_BIN_EXE_lensrunner")).args(arguments).output().expect("the program starts");
    let help = String::from_utf8(run(&["project", "--help"]).stdout).unwrap();
    let wrong = run(&["project", "--method", "exakt"]);
    assert_eq!(wrong.status.code(), Some(2));
    let complaint = String::from_utf8(wrong.stderr).unwrap();
    for name in NAMES {
        assert!(help.contains(name) && complaint.contains(name), "{name} is not named");
    }
    assert!(methods::named("paper1-17").is_none() && methods::named("rk4-16").is_none());
}
