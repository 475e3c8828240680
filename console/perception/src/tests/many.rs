//! More objects than can be followed.

use super::*;

#[test]
fn obstacles_on_the_chart_make_room_for_others() {
    let mut drive = Drive::new(Vec::new(), Vec::new());
    drive.boundary = Boundary::Circle { radius_m: 12_000.0 };
    let mut ids = std::collections::BTreeSet::new();
    let columns = 520;
    for k in 0..columns {
        let x = 20.0 * f64::from(k);
        drive.real = vec![column(k, x, 1.5, 0.2)];
        drive.along((x - 0.4, 0.0), (x, 0.0), 12);
        assert_eq!(drive.perception.trouble(), None, "{k}");
        ids.extend(drive.perception.seen(&Pose::new(0.0, 0.0, 0.0)).map(|seen| seen.id));
    }
    assert_eq!(ids.len(), columns as usize);
    assert!(drive.perception.tracks() < columns as usize);
}

#[test]
fn a_scan_with_more_objects_than_can_be_followed_is_named() {
    let scanner = Scanner { rays: 4096, ..Scanner::default() };
    let mut drive = Drive::new(Vec::new(), Vec::new());
    drive.perception = Perception::new(Sensor::of(&scanner));
    drive.boundary = Boundary::Circle { radius_m: 60.0 };
    let pose = Pose::new(0.0, 0.0, 0.0);
    let mut scan = scan_of(&scanner, &drive.boundary, &[], &pose, 1);
    // Posts all around: four rays each, with gaps of four rays.
    for (n, mm) in scan.ranges_mm.0.iter_mut().enumerate() {
        *mm = if n / 4 % 2 == 0 { 7000 } else { world::NO_ECHO };
    }
    drive.take(&scan, &pose);
    assert_eq!((drive.perception.trouble(), drive.perception.tracks()), (None, 512));
    scan.ranges_mm.0[4..8].fill(5000);
    drive.take(&scan, &pose);
    let trouble = drive.perception.trouble().map(|why| why.to_string()).unwrap_or_default();
    assert!(trouble.contains("more than 512 objects"), "{trouble}");
}
