//! The toolkit of the charts: sheets, timing, provenance.

use std::path::Path;

use lensrunner_lab::chart::{
    Output, Provenance, Sheet, SheetError, Timing, interleaved, provenance, quantile, thread_time, times_the_first,
};

#[test]
fn a_sheet_comes_back_from_its_csv() {
    let folder = crate::support::Folder::new();
    let mut sheet = Sheet::new(&["name", "error, degrees"]);
    sheet.columns[1] = "error".into();
    sheet.notes.push(("date".into(), "2026-11-21".into()));
    sheet.push(["table", "0.004"]);
    let output = Output { folder: folder.path().join("deep/er"), redraw: false };
    let written = output.sheet::<SheetError>("s", || Ok(sheet.clone())).unwrap();
    assert_eq!(written, sheet);
    let again = Output { redraw: true, ..output.clone() };
    let read = again.sheet::<SheetError>("s", || panic!("a redrawing measures nothing")).unwrap();
    assert_eq!(read, sheet);
    assert_eq!(read.number(&read.rows[0], "error"), 0.004);
    assert!(read.number(&read.rows[0], "none").is_nan());
    assert!(matches!(again.sheet::<SheetError>("other", || panic!()), Err(SheetError::Io(..))));
    assert!(matches!(Sheet::from_csv(Path::new("x"), "a,b\n1\n"), Err(SheetError::Row(_, 2, 1, 2))));
    assert!(matches!(Sheet::from_csv(Path::new("x"), "# a: b\n"), Err(SheetError::Header(_))));
}

#[test]
fn contestants_take_turns() {
    let order = std::cell::RefCell::new(Vec::new());
    let times = interleaved(&mut [&mut || order.borrow_mut().push(0), &mut || order.borrow_mut().push(1)], 3);
    assert_eq!(*order.borrow(), [0, 1, 0, 1, 0, 1, 0, 1]);
    assert_eq!(times.len(), 2);
    assert_eq!(Timing::of(vec![3.0, 1.0, 2.0]), Timing { median: 2.0, least: 1.0, most: 3.0 });
}

#[test]
fn quantiles_lie_between_neighbours() {
    assert_eq!([0.0, 0.5, 1.0].map(|q| quantile([3.0, 1.0, 2.0, 4.0], q)), [1.0, 2.5, 4.0]);
    assert_eq!(quantile([7.0], 0.99), 7.0);
    assert!(quantile([], 0.5).is_nan());
}

/// The first round does not count, the next goes backwards.
#[test]
fn neighbours_are_compared() {
    thread_local! {
        static NOW: std::cell::Cell<f64> = const { std::cell::Cell::new(0.0) };
    }
    let order = std::cell::RefCell::new(Vec::new());
    let run = |name: usize, seconds: f64| {
        let cold = if order.borrow().len() < 2 { [1.0, 10.0][name] } else { 1.0 };
        order.borrow_mut().push(name);
        NOW.set(NOW.get() + cold * seconds);
    };
    let ratios = times_the_first(|| NOW.get(), &mut [&mut || run(0, 2.0), &mut || run(1, 3.0)], 1);
    assert_eq!(*order.borrow(), [0, 1, 1, 0]);
    assert_eq!(ratios, [1.0, 1.5]);
}

#[cfg(all(target_os = "linux", target_pointer_width = "64"))]
#[test]
fn the_processor_s_clock_stands_still_while_a_thread_sleeps() {
    let start = thread_time();
    std::thread::sleep(std::time::Duration::from_millis(200));
    let slept = thread_time() - start;
    // Falling asleep and waking take microseconds.
    assert!((0.0..0.1).contains(&slept), "{slept}");
    let mut sum = 0u64;
    for i in 0..20_000_000u64 {
        sum = std::hint::black_box(sum.wrapping_add(i));
    }
    assert!(thread_time() - start > slept, "{sum}");
}

#[test]
fn provenance_says_where_numbers_come_from() {
    assert_eq!(provenance::civil(0), [1970, 1, 1]);
    assert_eq!(provenance::civil(11_016), [2000, 2, 29]);
    assert_eq!(provenance::civil(20_778), [2026, 11, 21]);
    let now = Provenance::now("llvmpipe");
    let footer = Provenance::footer(&now.notes());
    assert_eq!(footer.len(), 2);
    assert!(footer[0].contains("adapter: llvmpipe") && footer[0].contains(&now.date), "{footer:?}");
    assert!(footer[1].starts_with("lensrunner"));
}
