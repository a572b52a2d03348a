//! Loops compiled for several instruction sets; each call uses the best that the processor supports.
//!
//! The results are the same bits for all of them: Rust never fuses or reorders floating point by itself.

/// Compiles a function once for each of these instruction sets and once for the baseline; without the feature `multiversion`
/// for the baseline alone.
macro_rules! vectorised {
    ($function:item) => {
        #[cfg_attr(
            feature = "multiversion",
            multiversion::multiversion(targets(
                "x86_64+avx512f+avx512bw+avx512dq+avx512vl+avx2+avx+fma+bmi2",
                "x86_64+avx2+avx+fma+bmi2"
            ))
        )]
        $function
    };
}

pub(crate) use vectorised;
