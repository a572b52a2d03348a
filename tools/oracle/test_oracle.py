"""The comparison accepts equal pixels and rejects all others, and the generators agree with other decoders."""

import contextlib
import dataclasses
import io
import itertools
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import numpy as np

import case as cases
import formats.registry
import manual
import run
from case import Case, Family, Reference
from compare import DIFFERENT, EQUAL, REFUSED, UNEXPECTED, Outcome, judge
from decoder import outcomes_of
from refusals import REFUSALS, refusal
from tally import Tally

ROWS = [refusal("PNG", "holes", "nobody knows why", "holes are not supported", content="holes")]


def png_case(values, content="pixels", **reference):
    return Case("PNG", {"content": content}, "png", b"", Reference(values, **reference))


def outcome_of(case, dtype=np.uint8):
    """The result of a perfect reader for a case."""
    full = {np.uint8: 255, np.uint16: 65535}.get(dtype, 1)
    values = case.reference.values * full
    samples = np.rint(values).astype(dtype) if full > 1 else values.astype(dtype)
    names = case.reference.channels or tuple("RGBA"[: samples.shape[2]])
    return Outcome(samples=samples, range=case.reference.range, channels=names)


class Judging(unittest.TestCase):
    bytes_case = png_case(np.arange(24).reshape(2, 4, 3) / 255, channels=("R", "G", "B"))

    def word(self, case, outcome):
        return judge(case, outcome, ROWS).word

    def test_the_same_pixels_are_equal(self):
        self.assertEqual(self.word(self.bytes_case, outcome_of(self.bytes_case)), EQUAL)
        # More precision than the file has is acceptable.
        self.assertEqual(self.word(self.bytes_case, outcome_of(self.bytes_case, np.uint16)), EQUAL)

    def test_one_step_of_one_sample_is_different(self):
        for dtype in (np.uint8, np.uint16):
            case = png_case(np.arange(24).reshape(2, 4, 3) / np.iinfo(dtype).max, full=np.iinfo(dtype).max)
            outcome = outcome_of(case, dtype)
            outcome.samples[1, 2, 0] += 1
            verdict = judge(case, outcome, ROWS)
            self.assertEqual(verdict.word, DIFFERENT)
            self.assertIn("x 2, y 1, channel 0", verdict.detail)

    def test_lost_precision_is_different(self):
        case = png_case(np.arange(0, 24000, 1000).reshape(2, 4, 3) / 65535, full=65535)
        self.assertEqual(self.word(case, outcome_of(case, np.uint16)), EQUAL)
        self.assertEqual(self.word(case, outcome_of(case, np.uint8)), DIFFERENT)

    def test_floats_must_be_the_same_bits(self):
        case = png_case(np.array([[1.1, np.nan, np.inf, -0.25]]), full=None, range="Float")
        outcome = outcome_of(case, np.float32)
        self.assertEqual(self.word(case, outcome), EQUAL)
        for index, value in [(0, np.nextafter(np.float32(1.1), np.float32(2))), (1, 0.0), (2, -np.inf), (3, np.nan)]:
            changed = dataclasses.replace(outcome, samples=outcome.samples.copy())
            changed.samples[0, index, 0] = value
            self.assertEqual(self.word(case, changed), DIFFERENT, index)

    def test_tolerances_of_lossy_codecs_end_where_they_say(self):
        case = png_case(np.full((4, 4, 1), 100 / 255), tolerance=4 / 255, mean_tolerance=1 / 255)
        outcome = outcome_of(case)
        outcome.samples[0, 0] += 4
        self.assertEqual(self.word(case, outcome), EQUAL)
        outcome.samples[0, 0] += 1
        self.assertEqual(self.word(case, outcome), DIFFERENT)
        outcome.samples[:] = 102
        self.assertEqual(self.word(case, outcome), DIFFERENT)

    def test_size_channels_and_range_count(self):
        right = outcome_of(self.bytes_case)
        wrong = [
            dataclasses.replace(right, samples=right.samples.reshape(4, 2, 3)),
            dataclasses.replace(right, samples=right.samples[:, :, :2]),
            dataclasses.replace(right, channels=("B", "G", "R")),
            dataclasses.replace(right, range="Snorm"),
        ]
        for outcome in wrong:
            self.assertEqual(self.word(self.bytes_case, outcome), DIFFERENT)

    def test_only_what_may_be_left_out_may_be(self):
        case = png_case(np.arange(16).reshape(2, 2, 4) / 255, optional=1)
        whole = outcome_of(case)
        self.assertEqual(self.word(case, whole), EQUAL)
        self.assertEqual(self.word(case, dataclasses.replace(whole, samples=whole.samples[:, :, :3])), EQUAL)
        self.assertEqual(self.word(case, dataclasses.replace(whole, samples=whole.samples[:, :, :2])), DIFFERENT)

    def test_the_order_is_free_only_where_the_format_leaves_it_open(self):
        case = png_case(np.arange(8).reshape(2, 2, 2) / 255, either_order=True)
        turned = outcome_of(case)
        turned.samples = turned.samples[:, :, ::-1].copy()
        self.assertEqual(self.word(case, turned), EQUAL)
        self.assertEqual(self.word(png_case(case.reference.values), turned), DIFFERENT)
        turned.samples[0, 0, 0] ^= 1
        self.assertEqual(self.word(case, turned), DIFFERENT)

    def test_refusals_need_a_row_and_its_words(self):
        holes = png_case(np.zeros((1, 1)), "holes")
        expected = Outcome(error="PNG: holes are not supported: fill them")
        self.assertEqual(self.word(holes, expected), REFUSED)
        self.assertEqual(self.word(holes, Outcome(error="PNG: broken file")), UNEXPECTED)
        self.assertEqual(self.word(self.bytes_case, expected), UNEXPECTED)

    def test_a_panic_is_a_failure(self):
        holes = png_case(np.zeros((1, 1)), "holes")
        self.assertEqual(self.word(holes, Outcome(error="holes are not supported", panicked=True)), DIFFERENT)


class Answers(unittest.TestCase):
    def test_samples_follow_one_another(self):
        answers = ["read\t2\t1\tY\tu8\tUnorm\t", "refused\tno", "read\t1\t1\tR,G\tf32\tFloat\ta warning", "panicked\toh"]
        first, second, third, fourth = outcomes_of(answers, bytes([7, 8]) + np.array([0.5, -2], "<f4").tobytes())
        self.assertEqual((first.samples.tolist(), first.channels), ([[[7], [8]]], ("Y",)))
        self.assertEqual((second.samples, second.error), (None, "no"))
        self.assertEqual((third.samples.tolist(), third.warnings), ([[[0.5, -2.0]]], "a warning"))
        self.assertTrue(fourth.panicked)


class Choosing(unittest.TestCase):
    def family(self, make):
        return Family("PNG", {"a": [1, 2, 3], "b": ["x", "y"], "c": [False, True]}, make)

    def test_every_pair_occurs(self):
        family = self.family(lambda rng, **values: ("png", b"", Reference(np.zeros((1, 1)))))
        chosen = [case.traits for case in cases.pairs(family, 1)]
        self.assertLess(len(chosen), 12)
        for one, other in itertools.combinations(family.axes, 2):
            pairs = {(traits[one], traits[other]) for traits in chosen}
            self.assertEqual(len(pairs), len(family.axes[one]) * len(family.axes[other]))
        self.assertEqual(len(list(cases.every(family))), 12)

    def test_what_the_format_forbids_is_left_out(self):
        def make(rng, a, b, c):
            return None if a == 3 else ("png", b"", Reference(np.zeros((1, 1))))

        for chosen in (cases.pairs(self.family(make), 1), cases.every(self.family(make))):
            self.assertEqual({case.traits["a"] for case in chosen}, {1, 2})

    def test_a_combination_is_always_the_same_file(self):
        family = formats.registry.families(["png"])[0]
        combination = {name: values[0] for name, values in family.axes.items()}
        self.assertEqual(family.case(combination).data, family.case(combination).data)


class Runs(unittest.TestCase):
    """The whole comparison with a reader that is right, or nearly."""

    def status(self, spoil):
        def decode(program, batch, folder):
            outcomes = [outcome_of(case, np.uint16) for case in batch]
            spoil(outcomes)
            return outcomes

        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()) as text:
            words = ["--format", "png", "--decoder", "none", "--keep", folder]
            with mock.patch("run.decode", decode):
                return run.main(words), len(list(Path(folder).iterdir())), text.getvalue()

    def test_all_equal(self):
        status, kept, text = self.status(lambda outcomes: None)
        self.assertEqual((status, kept), (0, 0), text)

    def test_one_sample_of_one_file_fails_the_run_and_keeps_the_file(self):
        def spoil(outcomes):
            if len(outcomes) == run.BATCH:
                outcomes[17].samples[0, 0, 0] ^= 1

        status, kept, text = self.status(spoil)
        self.assertEqual((status, kept), (1, 1))
        self.assertIn("1 different", text)

    def test_a_row_that_is_not_true_any_more_fails(self):
        tally = Tally(Path("nowhere"), ROWS)
        self.assertEqual(len(list(tally.stale_rules({"PNG"}))), 1)
        self.assertEqual(list(tally.stale_rules({"TGA"})), [])
        tally.add(png_case(np.zeros((1, 1)), "holes"), Outcome(error="holes are not supported"))
        self.assertEqual(list(tally.stale_rules({"PNG"})), [])


class Generators(unittest.TestCase):
    def test_every_format_has_files(self):
        names = {family.format.lower() for family in formats.registry.families()}
        self.assertEqual(names, {module.split("_")[0] for module in formats.registry.MODULES})

    def test_every_row_of_the_table_speaks_of_files_that_are_generated(self):
        families = formats.registry.families()
        for rule in REFUSALS:
            axes = [family.axes for family in families if family.format == rule.format]
            named = any(
                all(key in each and set(values) <= set(each[key]) for key, values in rule.when) for each in axes
            )
            self.assertTrue(named, f"{rule.format}: {rule.what}")


class Manual(unittest.TestCase):
    def test_the_manual_has_the_table(self):
        self.assertEqual(manual.PAGE.read_text(), manual.updated(manual.PAGE.read_text()), "run tools/oracle/manual.py")

    def test_a_missing_place_is_an_error(self):
        with self.assertRaises(ValueError):
            manual.updated("a page without the marks")


if __name__ == "__main__":
    unittest.main()
