"""The harness of the benchmarks: stored results are read back whole, and a comparison tells noise from a loss."""

import os
import sys
import tempfile
import types
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(sys.argv.pop(1), "benchmarks", "harness"))

import compare  # noqa: E402
import output  # noqa: E402

COLUMNS = [("method", "method"), ("milliseconds", "ms"), ("low", "low"), ("high", "high"), ("error", "error")]


def context(folder):
    return types.SimpleNamespace(results=folder, provenance={"commit": "abc", "processor": "one"}, machine={"product_gflops": 50.0}, lines=[])


def rows(milliseconds, low, high, error=1e-12):
    return [{"method": "ours", "milliseconds": milliseconds, "low": low, "high": high, "error": error, "not a column": 1}]


def stored(folder, measured):
    output.write_results(context(folder), "suite", measured, COLUMNS, ("method",))
    return compare.load(folder)


class Results(unittest.TestCase):
    def test_a_result_carries_its_provenance_and_machine(self):
        with tempfile.TemporaryDirectory() as folder:
            stored(folder, rows(1.0, 0.9, 1.1))
            read = output.read_results(os.path.join(folder, "suite.json"))
            self.assertEqual(read["provenance"], {"commit": "abc", "processor": "one"})
            self.assertEqual(read["machine"], {"product_gflops": 50.0})
            self.assertEqual(read["rows"], [{"method": "ours", "milliseconds": 1.0, "low": 0.9, "high": 1.1, "error": 1e-12}])
            with open(os.path.join(folder, "suite.csv"), encoding="utf-8") as text:
                self.assertEqual(text.read().splitlines()[:4], ["# commit: abc", "# processor: one", "method,milliseconds,low,high,error",
                                                                "ours,1.0,0.9,1.1,1e-12"])

    def test_a_folder_without_results_is_refused(self):
        with tempfile.TemporaryDirectory() as folder, self.assertRaises(SystemExit):
            compare.load(folder)


class Comparison(unittest.TestCase):
    def drops(self, before, after):
        with tempfile.TemporaryDirectory() as one, tempfile.TemporaryDirectory() as other:
            return compare.drops(stored(one, before), stored(other, after))[0]

    def test_quartiles_that_lie_apart_are_a_loss(self):
        self.assertEqual(self.drops(rows(1.0, 0.95, 1.05), rows(1.25, 1.2, 1.3)), ["slower: suite, ours: milliseconds 1.25, was 1"])

    def test_quartiles_that_overlap_are_noise(self):
        self.assertEqual(self.drops(rows(1.0, 0.8, 1.3), rows(1.25, 1.2, 1.3)), [])

    def test_without_quartiles_only_a_large_factor_is_a_loss(self):
        self.assertEqual(self.drops(rows(1.0, None, None), rows(1.25, None, None)), [])
        self.assertEqual(len(self.drops(rows(1.0, None, None), rows(1.4, None, None))), 1)

    def test_digits_lost_are_a_loss_and_rounding_is_not(self):
        same = (1.0, 0.9, 1.1)
        self.assertEqual(len(self.drops(rows(*same, error=1e-12), rows(*same, error=2e-11))), 1)
        self.assertEqual(self.drops(rows(*same, error=1e-17), rows(*same, error=5e-15)), [])

    def test_what_became_faster_is_no_loss(self):
        self.assertEqual(self.drops(rows(1.0, 0.95, 1.05), rows(0.5, 0.45, 0.55)), [])


if __name__ == "__main__":
    unittest.main()
