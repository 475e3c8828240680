//! Noise that depends only on what it belongs to, so that any part of the readings can be computed by itself.

use std::f64::consts::TAU;

/// A number from a normal distribution with mean 0 and standard deviation 1, determined by a key.
pub(super) fn normal(key: [u64; 4]) -> f64 {
    let seed = key.into_iter().fold(0x9e37_79b9_7f4a_7c15, |state, part| mixed(state ^ mixed(part)));
    let (one, other) = (unit(mixed(seed)), unit(mixed(seed ^ 0xd1b5_4a32_d192_ed03)));
    (-2.0 * one.ln()).sqrt() * (TAU * other).cos()
}

/// The mixing function of `SplitMix64`.
fn mixed(state: u64) -> u64 {
    let state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let state = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let state = (state ^ (state >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    state ^ (state >> 31)
}

/// A number above 0 and at most 1.
fn unit(bits: u64) -> f64 {
    ((bits >> 11) + 1) as f64 / (1_u64 << 53) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_neighbouring_keys_are_normal_and_independent() {
        let numbers: Vec<f64> = (0..100_000).map(|k| normal([7, k / 40, 1, k % 40])).collect();
        let n = numbers.len() as f64;
        let mean = numbers.iter().sum::<f64>() / n;
        let variance = numbers.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n;
        let within = numbers.iter().filter(|x| x.abs() < 1.96).count() as f64 / n;
        let next = numbers.windows(2).map(|pair| pair[0] * pair[1]).sum::<f64>() / n;
        assert!(mean.abs() < 0.01 && (variance - 1.0).abs() < 0.02, "{mean} {variance}");
        assert!((within - 0.95).abs() < 0.004 && next.abs() < 0.01, "{within} {next}");
    }
}
