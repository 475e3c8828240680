//! The t-test of Table 3.

use crate::sample::Sample;

/// Nodes of the integral over the tail.
const NODES: u32 = 400;

/// Probability of a mean at least this far from 0 if it were 0: one sample, two sides, n - 1 degrees of freedom.
pub fn p_value(sample: &Sample) -> Option<f64> {
    let n = sample.len() as f64;
    let t = sample.mean()? / (sample.standard_deviation()? / n.sqrt());
    Some(2.0 * tail(t.abs(), n - 1.0))
}

/// Probability that Student's t with `k` degrees of freedom exceeds `t`, by its integral with `x = t / u`.
///
/// The tail is far too small for one minus the rest: it is 1e-31 here.
fn tail(t: f64, k: f64) -> f64 {
    if t <= 0.0 {
        return 0.5;
    }
    // The density is c (1 + x^2 / k)^(-(k + 1) / 2); the integrand below is smooth from u = 0 to 1.
    let density = |u: f64| {
        if u <= 0.0 {
            return 0.0;
        }
        let x = t / u;
        (-(k + 1.0) / 2.0 * (x * x / k).ln_1p()).exp() * t / (u * u)
    };
    let h = 1.0 / f64::from(NODES);
    let simpson: f64 = (0..=NODES)
        .map(|i| {
            let weight = if i == 0 || i == NODES {
                1.0
            } else if i % 2 == 1 {
                4.0
            } else {
                2.0
            };
            weight * density(f64::from(i) * h)
        })
        .sum();
    constant(k) * simpson * h / 3.0
}

/// `gamma((k + 1) / 2) / (sqrt(k pi) gamma(k / 2))` for whole `k`, from that of 1 or 2 by steps of two.
fn constant(k: f64) -> f64 {
    let (mut at, mut ratio) = if k % 2.0 == 0.0 {
        // gamma(3/2) / gamma(1)
        (2.0, std::f64::consts::PI.sqrt() / 2.0)
    } else {
        // gamma(1) / gamma(1/2)
        (1.0, 1.0 / std::f64::consts::PI.sqrt())
    };
    while at < k {
        ratio *= (at + 1.0) / at;
        at += 2.0;
    }
    ratio / (k * std::f64::consts::PI).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tails_are_those_of_the_tables() {
        for (t, k, table) in [
            (2.045_229_642, 29.0, 0.025),
            (3.396_240_288, 29.0, 0.001),
            (2.0, 2.0, 0.091_751_71),
            (12.706_204_74, 1.0, 0.025),
        ] {
            let ours = tail(t, k);
            assert!((ours / table - 1.0).abs() < 1e-5, "{t} {k}: {ours} for {table}");
        }
    }

    #[test]
    fn a_mean_of_fifty_deviations_has_a_tail_of_a_billionth_cubed() {
        // Far out the tail is c k^((k - 1) / 2 + 1) / t^k times (1 - ...): its logarithm falls by k ln 2 per doubling.
        let (near, far) = (tail(60.0, 29.0), tail(120.0, 29.0));
        assert!(near < 1e-30 && near > 1e-33, "{near}");
        assert!(((near / far).ln() / (29.0 * 2.0_f64.ln()) - 1.0).abs() < 0.01);
    }
}
