//! Scans that cannot be right, and right ones that differ from the usual.

use super::*;

#[test]
fn scans_that_cannot_be_right_are_named() {
    let drawn = vec![column(1, 2.0, 2.0, 0.2), column(2, -3.0, 0.0, 0.25), column(3, 0.5, -2.5, 0.3)];
    let pose = Pose::new(3.0, -2.0, 0.4);
    let named = |spoil: &dyn Fn(&mut Scan)| {
        let mut drive = Drive::new(drawn.clone(), drawn.clone());
        for _ in 0..10 {
            let mut scan = scan_of(&drive.scanner, &drive.boundary, &drive.real, &pose, drive.tick);
            spoil(&mut scan);
            drive.take(&scan, &pose);
            assert!(drive.shapes().is_empty(), "{:?}", drive.shapes());
        }
        drive.perception.trouble().map(|why| why.to_string()).unwrap_or_default()
    };
    assert_eq!(named(&|_| {}), "");
    let reverse = |scan: &mut Scan| scan.ranges_mm.0.reverse();
    let half = |scan: &mut Scan| scan.ranges_mm.0.rotate_left(180);
    for (spoil, wanted) in [
        (&reverse as &dyn Fn(&mut Scan), "only if it is mirrored"),
        (&half, "only if it is rotated by half a turn"),
        (&|scan| scan.ranges_mm.0.fill(world::NO_ECHO), "only 0 % of the rays"),
        (&|scan| scan.ranges_mm.0.fill(0), "all distances of the scan are 0"),
        (&|scan| scan.ranges_mm.0.fill(100), "only 0 % of the scan fits the drawing"),
        (&|scan| scan.ranges_mm.0.clear(), "the scan has no rays"),
        (&|scan| scan.ranges_mm.0.truncate(180), "the scan has 180 rays instead of 360"),
        (&|scan| scan.step_rad = f64::NAN, "are not numbers"),
        (&|scan| scan.step_rad = 0.0, "are not numbers"),
    ] {
        let found = named(spoil);
        assert!(found.contains(wanted), "{wanted}: {found:?}");
    }
}

#[test]
fn a_scanner_that_sees_only_a_few_columns_is_judged_too() {
    let drawn = [(2.6, 1.5), (-2.8, 1.9), (0.4, -3.1), (-5.0, -3.1)];
    let drawn: Vec<Obstacle> = (1..).zip(drawn).map(|(id, (x, y))| column(id, x, y, 0.25)).collect();
    let pose = Pose::new(0.0, 0.0, 1.57);
    let judged = |spoil: &dyn Fn(&mut Scan)| {
        let mut drive = Drive::new(drawn.clone(), drawn.clone());
        drive.boundary = Boundary::Circle { radius_m: 9.0 };
        for _ in 0..10 {
            let mut scan = scan_of(&drive.scanner, &drive.boundary, &drive.real, &pose, drive.tick);
            spoil(&mut scan);
            drive.take(&scan, &pose);
        }
        drive.perception.trouble()
    };
    assert_eq!(judged(&|_| {}), None);
    assert_eq!(judged(&|scan| scan.ranges_mm.0.reverse()), Some(Trouble::Mirrored { by: Shown::Drawing }));
    assert_eq!(
        judged(&|scan| scan.ranges_mm.0.rotate_left(180)),
        Some(Trouble::Backwards { by: Shown::Drawing })
    );
    assert_eq!(judged(&|scan| scan.ranges_mm.0.fill(world::NO_ECHO)), Some(Trouble::NoEcho { share: 0.0 }));
}

/// In a round tank without a drawing, only the motion of the robot shows that the directions of its scans are wrong.
#[test]
fn scans_that_contradict_the_motion_are_named_without_a_drawing() {
    let real = vec![column(1, 2.0, 2.0, 0.2), column(2, -3.0, 0.0, 0.25), column(3, 0.5, -2.5, 0.3)];
    let turn = (0..60).map(|k| Pose::new(0.0, 0.0, 0.05 * f64::from(k)));
    let along = |k: u32| Point::origin() + geometry::unit_vector(2.95) * (0.04 * f64::from(k));
    let drive = (0..60).map(|k| Pose::new(along(k).x, along(k).y, 2.95));
    let way: Vec<Pose> = turn.chain(drive).collect();
    let judged = |spoil: &dyn Fn(&mut Scan)| {
        let mut drive = Drive::new(real.clone(), Vec::new());
        // The wall is beyond the range of the scanner.
        drive.boundary = Boundary::Circle { radius_m: 12.0 };
        for pose in &way {
            let mut scan = scan_of(&drive.scanner, &drive.boundary, &drive.real, pose, drive.tick);
            spoil(&mut scan);
            drive.take(&scan, pose);
        }
        drive.perception.trouble()
    };
    assert_eq!(judged(&|_| {}), None);
    let by = Shown::Motion;
    assert_eq!(judged(&|scan| scan.ranges_mm.0.reverse()), Some(Trouble::Mirrored { by }));
    assert_eq!(judged(&|scan| scan.ranges_mm.0.rotate_left(180)), Some(Trouble::Backwards { by }));
}

/// A drive with a scanner that no scenario describes, in a tank whose wall is beyond the scanner's range.
fn unknown_scanner() -> Drive {
    let mut drive = Drive::new(Vec::new(), Vec::new());
    drive.perception = Perception::new(Sensor::UNKNOWN);
    drive.boundary = Boundary::Circle { radius_m: 12.0 };
    drive
}

#[test]
fn a_wall_beyond_the_range_is_no_reason_to_reject_a_scan() {
    for range_max_m in [None, Some(8.0)] {
        let mut drive = unknown_scanner();
        for x in [0.0, 1.0, 4.0] {
            let pose = Pose::new(x, 0.0, 0.2);
            for _ in 0..20 {
                let scan = scan_of(&drive.scanner, &drive.boundary, &[], &pose, drive.tick);
                drive.take(&Scan { range_max_m, ..scan }, &pose);
                assert_eq!(drive.perception.trouble(), None, "{range_max_m:?} at {x}");
            }
        }
    }
}

#[test]
fn a_scanner_that_states_its_range_and_has_no_echo_is_named() {
    let mut drive = unknown_scanner();
    let pose = Pose::new(8.0, 0.0, 0.2);
    for _ in 0..10 {
        let mut scan = scan_of(&drive.scanner, &drive.boundary, &[], &pose, drive.tick);
        scan.range_max_m = Some(8.0);
        scan.ranges_mm.0.fill(world::NO_ECHO);
        drive.take(&scan, &pose);
    }
    assert!(drive.perception.trouble().is_some_and(|why| why.to_string().contains("only 0 % of the rays")));
}

#[test]
fn an_unknown_scanner_may_leave_out_half_of_its_rays() {
    let mut drive = unknown_scanner();
    let pose = Pose::new(8.0, 0.0, 0.2);
    for (rays, wanted) in [(360, None), (300, None), (180, None), (361, None), (179, Some("at least 180"))] {
        let scanner = Scanner { rays, ..drive.scanner };
        let scan = scan_of(&scanner, &drive.boundary, &[], &pose, drive.tick);
        drive.take(&scan, &pose);
        let trouble = drive.perception.trouble();
        assert_eq!(trouble.is_some(), wanted.is_some(), "{rays}: {trouble:?}");
        assert!(
            wanted.is_none_or(|wanted| trouble.is_some_and(|why| why.to_string().contains(wanted))),
            "{trouble:?}"
        );
    }
}

#[test]
fn a_way_that_could_not_be_compared_is_no_misfit() {
    let scanner =
        Scanner { range_m: 8.0, field_of_view_rad: 1.0, rays: 36, lost_share: 0.0, ..Scanner::default() };
    let mut drive = Drive::new(Vec::new(), Vec::new());
    drive.perception = Perception::new(Sensor::of(&scanner));
    drive.boundary = Boundary::Circle { radius_m: 12.0 };
    for k in 0..40 {
        let pose = Pose::new(7.0, 0.0, 0.0);
        let mut scan = scan_of(&scanner, &drive.boundary, &[], &pose, drive.tick);
        // At first, too few rays have an echo to be compared.
        if k < 30 {
            let lost = |(n, mm): (usize, &mut u16)| {
                if n % 5 != 0 {
                    *mm = world::NO_ECHO;
                }
            };
            scan.ranges_mm.0.iter_mut().enumerate().for_each(lost);
        }
        drive.take(&scan, &pose);
        assert_eq!(drive.perception.trouble(), None, "{k}");
    }
}

#[test]
fn echoes_from_too_near_are_no_obstacles_and_no_free_space() {
    let drawn = column(1, 1.5, 0.0, 0.2);
    for too_near_mm in [0, 150] {
        let mut drive = Drive::new(vec![drawn.clone()], vec![drawn.clone()]);
        for _ in 0..60 {
            let pose = Pose::new(0.0, 0.0, 0.0);
            let mut scan = scan_of(&drive.scanner, &drive.boundary, &drive.real, &pose, drive.tick);
            // An object at the hull covers the drawn column.
            scan.ranges_mm.0[160..200].fill(too_near_mm);
            drive.take(&scan, &pose);
            assert!(drive.shapes().is_empty(), "{too_near_mm}: {:?}", drive.shapes());
        }
        assert_eq!((drive.perception.trouble(), &drive.looked), (None, &Looked::default()));
    }
}

#[test]
fn scans_that_become_wrong_under_way_are_named_and_chart_nothing() {
    let drawn = vec![column(1, 2.0, 2.0, 0.2), column(2, -3.0, 0.0, 0.25)];
    let pose = Pose::new(-3.5, -0.8, 0.0);
    for (spoil, wanted) in [
        ((|scan| scan.ranges_mm.0.reverse()) as fn(&mut Scan), Trouble::Mirrored { by: Shown::Drawing }),
        (|scan| scan.ranges_mm.0.rotate_left(180), Trouble::Backwards { by: Shown::Drawing }),
    ] {
        let mut drive = Drive::new(drawn.clone(), drawn.clone());
        for tick in 0..60 {
            let mut scan = scan_of(&drive.scanner, &drive.boundary, &drive.real, &pose, drive.tick);
            if tick >= 20 {
                spoil(&mut scan);
            }
            drive.take(&scan, &pose);
            assert!(drive.shapes().is_empty(), "{tick}: {:?}", drive.shapes());
        }
        assert_eq!(drive.perception.trouble(), Some(wanted));
    }
}
