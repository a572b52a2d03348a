"""Compares our reader's result for a file with its reference: equal, refused or different."""

from dataclasses import dataclass, replace

import numpy as np

from case import HALF_STEP

EQUAL, REFUSED, DIFFERENT, UNEXPECTED = "equal", "refused", "different", "refused without a reason"


@dataclass
class Outcome:
    """Our reader's result for a file: samples[y, x, channel] in their stored type, or the line of its error."""

    samples: np.ndarray | None = None
    range: str = ""
    channels: tuple = ()
    error: str = ""
    warnings: str = ""
    panicked: bool = False


@dataclass
class Verdict:
    """The verdict in a word, and its details."""

    word: str
    detail: str = ""
    rule: object = None


# The number of steps from 0 to 1 for unsigned samples.
FULL = {np.dtype(np.uint8): 255, np.dtype(np.uint16): 65535}


def value_of(samples):
    """Stored samples as float64: unsigned integers as 0 ..= 1, floats unchanged."""
    with np.errstate(invalid="ignore"):
        return samples.astype(np.float64) / FULL.get(samples.dtype, 1)


def judge(case, outcome, refusals):
    """The verdict on one file."""
    if outcome.panicked:
        return Verdict(DIFFERENT, f"panicked: {outcome.error}")
    if outcome.samples is None:
        for rule in refusals:
            if rule.covers(case) and rule.matches(outcome.error):
                return Verdict(REFUSED, outcome.error, rule)
        return Verdict(UNEXPECTED, outcome.error)
    fault = difference(case.reference, outcome)
    if fault and case.reference.either_order:
        fault = difference(exchanged(case.reference), outcome) and fault
    return Verdict(DIFFERENT, fault) if fault else Verdict(EQUAL)


def exchanged(reference):
    """The reference with its first two channels in the other order."""
    order = [1, 0, *range(2, reference.values.shape[2])]
    return replace(reference, values=reference.values[:, :, order])


def difference(reference, outcome):
    """How the samples differ from the reference; empty if they do not."""
    expected, samples = reference.values, outcome.samples
    kept = samples.shape[2]
    if expected.shape[2] - reference.optional <= kept < expected.shape[2]:
        reference = replace(reference, values=expected[:, :, :kept])
        expected = reference.values
    if samples.shape != expected.shape:
        return f"{shape_words(samples.shape)} instead of {shape_words(expected.shape)}"
    if reference.channels and tuple(outcome.channels) != tuple(reference.channels):
        return f"channels {', '.join(outcome.channels)} instead of {', '.join(reference.channels)}"
    if outcome.range != reference.range:
        return f"numbers called {outcome.range} instead of {reference.range}"
    values = value_of(samples)
    with np.errstate(invalid="ignore"):
        errors = np.where(same_non_finite(values, expected), 0.0, np.abs(values - expected))
    errors = np.where(np.isnan(errors), np.inf, errors)
    allowed = allowance(reference, samples.dtype)
    wrong = errors > allowed
    if wrong.any():
        y, x, channel = np.argwhere(wrong)[0]
        share = 100 * wrong.any(axis=2).mean()
        return (
            f"{share:.3g}% of the pixels, at most by {errors.max():.6g}; first at x {x}, y {y}, channel {channel}:"
            f" {values[y, x, channel]:.9g} instead of {expected[y, x, channel]:.9g}"
        )
    mean = errors.mean()
    if reference.mean_tolerance is not None and mean > reference.mean_tolerance:
        return f"by {mean:.6g} on average, more than {reference.mean_tolerance:.6g}"
    return ""


def allowance(reference, stored):
    """How far each value may be from the reference: rounded to the steps of the stored type, of which there must not be
    fewer than the reference requires."""
    if reference.tolerance:
        # Differences of whole steps are not exact in float64.
        return np.full(reference.values.shape, reference.tolerance * (1 + 1e-9))
    if reference.full is not None:
        return np.full(reference.values.shape, HALF_STEP / max(reference.full, FULL.get(stored, 0)))
    with np.errstate(over="ignore", invalid="ignore"):
        single = reference.values.astype(np.float32)
        # The distance to the nearest single float, plus as many steps as the reference allows.
        rounding = np.abs(single.astype(np.float64) - reference.values)
        step = np.spacing(np.abs(single)).astype(np.float64) * reference.float_ulps
    return np.nan_to_num(rounding + step, nan=0.0, posinf=0.0)


def same_non_finite(values, expected):
    """True where both are NaN, or both the same infinity."""
    with np.errstate(over="ignore", invalid="ignore"):
        expected = expected.astype(np.float32)
    both_nan = np.isnan(values) & np.isnan(expected)
    return both_nan | (np.isinf(values) & (values == expected))


def shape_words(shape):
    return f"{shape[1]}x{shape[0]} with {shape[2]} channels"
