//! `tankops map`: shows how an occupancy map is interpreted.

use crate::{
    cli::MapArgs,
    output::{check_free, write_file},
};
use ::import::{MapFloor, OccupancyMap};
use flight::failure::{COMPLETE, bad_input};
use report::{drawing, print::say};
use std::{fmt::Write, process::ExitCode};
use world::{Obstacle, ObstacleId, Point, Shape, World};

/// Runs `tankops map`.
pub(crate) fn map(args: &MapArgs) -> anyhow::Result<ExitCode> {
    args.svg.as_ref().map_or(Ok(()), |file| check_free(file, Some(args.force), &[&args.map]))?;
    let map = OccupancyMap::read(&args.map).map_err(|error| bad_input(error.to_string()))?;
    let start = args.start.map(|[x, y]| Point::new(x, y));
    if let Some(solid) = start.filter(|start| !map.is_free_at(*start)) {
        return Err(bad_input(format!(
            "--start {},{}: no free floor at this point in {}; without --start, the largest free area is used",
            solid.x,
            solid.y,
            args.map.display()
        )));
    }
    let floor = MapFloor::new(&map, start, args.simplify).ok_or_else(|| {
        let why = map.unseen.map(|unseen| format!("; {unseen}")).unwrap_or_default();
        bad_input(format!("{}: has no free floor{why}", args.map.display()))
    })?;
    if let Some(file) = &args.svg {
        write_file("the drawing", file, &drawing::floor(&world_of(&floor), &[]))?;
    }
    say(&human(args, &map, &floor))?;
    Ok(ExitCode::from(COMPLETE))
}

fn world_of(floor: &MapFloor) -> World {
    let obstacle = |(index, vertices): (usize, &Vec<Point>)| {
        let shape = Shape::Polygon { vertices: vertices.clone() };
        Obstacle { id: ObstacleId(index as u32 + 1), name: format!("map {}", index + 1), shape, known: true }
    };
    World {
        boundary: floor.wall.clone(),
        obstacles: floor.pieces.iter().enumerate().map(obstacle).collect(),
        stations: Vec::new(),
        zones: Vec::new(),
    }
}

fn human(args: &MapArgs, map: &OccupancyMap, floor: &MapFloor) -> String {
    let (columns, rows, cell_m) = (map.columns, map.rows(), map.cell_m);
    let area_m2 = |cells: usize| cells as f64 * cell_m * cell_m;
    let size_m = |cells: usize| cells as f64 * cell_m;
    let mut text = format!(
        "{}: {columns} x {rows} cells of {cell_m} m, {:.2} x {:.2} m\n",
        args.map.display(),
        size_m(columns),
        size_m(rows)
    );
    let elsewhere = floor.n_free_in_map - floor.n_free;
    let [before, after] = floor.n_corners;
    // Writing to a String cannot fail.
    let _ = write!(
        text,
        "free floor           {:.1} m² in {} cells; free cells elsewhere, which count as solid: {elsewhere}\n\
         outlines             {}, with {before} corners, {after} after simplification\n\
         convex pieces        {}\n\
         largest shape error  {:.4} m ({:.2} cells), on the safe side\n",
        area_m2(floor.n_free),
        floor.n_free,
        floor.n_outlines,
        floor.pieces.len(),
        floor.error_m,
        floor.error_m / cell_m,
    );
    if let Some(unseen) = map.unseen {
        let _ = writeln!(text, "not floor            {unseen}");
    }
    text
}
