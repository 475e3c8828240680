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

#[test]
fn a_cart_that_passes_behind_a_column_keeps_its_id() {
    let hides = column(1, 0.0, 0.5, 0.25);
    let mut drive = Drive::new(vec![hides.clone(), column(7, 0.0, 0.0, 0.2)], vec![hides]);
    let pose = Pose::new(0.0, -1.0, 0.3);
    let (mut ids, mut hidden) = (std::collections::BTreeSet::new(), 0);
    for k in 0..120 {
        let x = -2.0 + 0.035 * f64::from(k);
        drive.real[1] = column(7, x, 1.5, 0.2);
        drive.scan(&pose);
        let seen: Vec<_> = drive.perception.seen(&pose).map(|seen| seen.id).collect();
        hidden += u32::from(!ids.is_empty() && seen.is_empty());
        // The cart is visible if its centre is not in the shadow of the column.
        let is_visible = (x / 2.5).atan().abs() > (0.25_f64 / 1.5).asin() + 0.02;
        assert!(ids.is_empty() || !is_visible || seen.len() == 1, "{k}: {seen:?}");
        ids.extend(seen);
    }
    assert!(hidden >= 8, "{hidden}");
    assert_eq!(ids.len(), 1, "{ids:?}");
}

#[test]
fn movers_that_touched_and_parted_are_two_discs() {
    let mut drive = Drive::new(Vec::new(), Vec::new());
    let pose = Pose::new(0.0, -1.0, 0.3);
    let mut was_one = false;
    let mut apart_m = 0.16;
    for k in 0..160 {
        if k >= 60 {
            apart_m += 0.02;
        }
        drive.real = vec![column(7, -apart_m, 1.0, 0.2), column(8, apart_m, 1.0, 0.2)];
        drive.scan(&pose);
        was_one |= matches!(drive.shapes()[..], [Shape::Polygon { .. }]);
    }
    assert!(was_one, "the movers must have looked like one object");
    let shapes = drive.shapes();
    for at in [-apart_m, apart_m] {
        let is_it = |shape: &Shape| matches!(shape, Shape::Disc { center, .. } if (center - Point::new(at, 1.0)).norm() < 0.15);
        assert_eq!(shapes.iter().filter(|shape| is_it(shape)).count(), 1, "{at} {shapes:?}");
    }
    assert_eq!((shapes.len(), drive.perception.tracks()), (2, 2), "{shapes:?}");
}
