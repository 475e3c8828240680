//! Moving obstacles.

use super::*;

#[test]
fn a_mover_keeps_one_id_and_is_no_row_of_columns() {
    let mut drive = Drive::new(vec![column(7, -2.0, 1.5, 0.25)], Vec::new());
    let mut most = 0;
    for k in 0..200 {
        drive.real[0] = column(7, -2.0 + 0.02 * f64::from(k), 1.5, 0.25);
        drive.scan(&Pose::new(0.0, -1.0, 0.3));
        most = most.max(drive.shapes().len());
    }
    assert_eq!(most, 1);
    let pose = Pose::new(0.0, -1.0, 0.3);
    let seen: Vec<_> = drive.perception.seen(&pose).collect();
    let velocity = seen[0].drift.velocity().unwrap();
    assert!((velocity - geometry::Vector::new(0.2, 0.0)).norm() < 0.05, "{velocity}");
    assert!((seen[0].shape.center() - Point::new(1.98, 1.5)).norm() < 0.1, "{:?}", seen[0].shape);
    assert_eq!(drive.perception.tracks(), 1);
}
