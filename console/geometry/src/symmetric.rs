//! Serializes symmetric matrices: the upper triangle, row by row.

use nalgebra::SMatrix;
use serde::{Deserialize, Deserializer, Serializer, de::Error, ser::SerializeSeq};

/// Serializes the upper triangle.
///
/// # Errors
/// The serializer fails.
pub fn serialize<S: Serializer, const N: usize>(
    matrix: &SMatrix<f64, N, N>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    // The length is given because binary formats write it first.
    let mut numbers = serializer.serialize_seq(Some(N * (N + 1) / 2))?;
    for (row, column) in (0..N).flat_map(|row| (row..N).map(move |column| (row, column))) {
        numbers.serialize_element(&matrix[(row, column)])?;
    }
    numbers.end()
}

/// Deserializes an upper triangle.
///
/// # Errors
/// There are too few or too many numbers.
pub fn deserialize<'de, D: Deserializer<'de>, const N: usize>(
    deserializer: D,
) -> Result<SMatrix<f64, N, N>, D::Error> {
    let numbers = Vec::<f64>::deserialize(deserializer)?;
    let triangle = N * (N + 1) / 2;
    let index = |row: usize, column: usize| {
        let (row, column) = (row.min(column), row.max(column));
        row * N + column - row * (row + 1) / 2
    };
    if numbers.len() != triangle {
        let n = numbers.len();
        return Err(D::Error::custom(format!(
            "a symmetric matrix of {N} rows has {triangle} numbers, not {n}"
        )));
    }
    Ok(SMatrix::from_fn(|row, column| numbers[index(row, column)]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix3;

    #[derive(serde::Serialize, Deserialize)]
    struct Known(#[serde(with = "super")] Matrix3<f64>);

    #[test]
    fn a_matrix_is_written_once_above_its_diagonal_and_read_so() {
        let matrix = Matrix3::new(1.0, 2.0, 3.0, 2.0, 4.0, 5.0, 3.0, 5.0, 6.0);
        let text = serde_json::to_string(&Known(matrix)).unwrap();
        assert_eq!(text, "[1.0,2.0,3.0,4.0,5.0,6.0]");
        let read = |text: &str| serde_json::from_str::<Known>(text).map(|known| known.0);
        assert_eq!(read(&text).unwrap(), matrix);
        assert_eq!(read("[1,2,3,4,5,6]").unwrap(), matrix);
        assert!(read("[1,2,3,2,4,5,3,5,6]").unwrap_err().to_string().contains("has 6 numbers, not 9"));
    }
}
