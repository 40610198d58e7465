"""The harness of the benchmarks: stored results are read back whole, and a comparison tells noise from a loss."""

import contextlib
import io
import json
import math
import os
import random
import subprocess
import sys
import tempfile
import types
import unittest
import xml.etree.ElementTree

sys.dont_write_bytecode = True
ROOT, TOPPLE = sys.argv.pop(1), sys.argv.pop(1)
sys.path.insert(0, os.path.join(ROOT, "benchmarks", "harness"))

import compare  # noqa: E402
import constants  # noqa: E402
import convergence  # noqa: E402
import debris  # noqa: E402
import labels  # noqa: E402
import other_peers  # noqa: E402
import output  # noqa: E402
import peers  # noqa: E402
import readme  # noqa: E402
import scaling  # noqa: E402

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

    def test_a_figure_says_where_it_comes_from_once(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "drawn.svg")
            with open(path, "w", encoding="utf-8") as out:
                out.write("<?xml version='1.0'?>\n<svg width='1'\n height='1'><g/></svg>\n")
            for _ in range(2):
                output.sign_figures(context(folder))
            root = xml.etree.ElementTree.parse(path).getroot()
            self.assertEqual([(child.tag, child.text) for child in root], [("metadata", "commit: abc\nprocessor: one\n"), ("g", None)])

    def test_only_a_folder_of_results_is_ever_replaced(self):
        with tempfile.TemporaryDirectory() as parent:
            folder = os.path.join(parent, "results")
            self.assertTrue(output.may_replace(folder))
            output.fresh_folder(folder)
            with open(os.path.join(folder, "own.json"), "w", encoding="utf-8"):
                pass
            self.assertTrue(output.may_replace(folder))
            output.fresh_folder(folder)
            self.assertEqual(os.listdir(folder), [output.MARK])
            self.assertFalse(output.may_replace(parent))  # it holds something that no run has written
            self.assertTrue(output.may_replace(parent, known=True))

    def test_one_file_can_be_compared_with_as_well_as_a_folder(self):
        with tempfile.TemporaryDirectory() as folder:
            whole = stored(folder, rows(1.0, 0.9, 1.1))
            self.assertEqual(compare.load(os.path.join(folder, "suite.json")), whole)

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

    def test_stages_of_scaling_their_memory_and_false_confidence_are_compared(self):
        columns = [("frame", "frame"), ("cut_step_seconds", "s"), ("cut_step_low", "low"), ("cut_step_high", "high"), ("factor_seconds", "s"), ("analysis_peak_mib", "MiB"),
                   ("false_confidence", "false")]
        before = {"frame": "2x2x4", "cut_step_seconds": 1.0, "cut_step_low": 0.9, "cut_step_high": 1.2, "factor_seconds": 1.0, "analysis_peak_mib": 100.0, "false_confidence": 0}

        def told(**changed):
            with tempfile.TemporaryDirectory() as one, tempfile.TemporaryDirectory() as other:
                for folder, row in ((one, before), (other, dict(before, **changed))):
                    output.write_results(context(folder), "scaling", [row], columns, ("frame",))
                return [line.split(":")[0] for line in compare.drops(compare.load(one), compare.load(other))[0]]
        self.assertEqual(told(), [])
        self.assertEqual(told(cut_step_seconds=1.4, cut_step_low=1.3, cut_step_high=1.5), ["slower"])
        self.assertEqual(told(cut_step_seconds=1.4, cut_step_low=1.1, cut_step_high=1.5), [])
        self.assertEqual(told(factor_seconds=1.2), [])
        self.assertEqual(told(factor_seconds=1.4), ["slower"])
        self.assertEqual(told(analysis_peak_mib=120.0), ["larger"])
        self.assertEqual(told(false_confidence=1), ["false confidence"])

    def test_a_run_on_another_processor_is_told(self):
        self.assertEqual(compare.differences({"processor": "one", "commit": "abc"}, {"processor": "two", "commit": "def"}), ["not alike: processor is two, was one"])

    def test_what_became_faster_is_no_loss(self):
        self.assertEqual(self.drops(rows(1.0, 0.95, 1.05), rows(0.5, 0.45, 0.55)), [])


class Readme(unittest.TestCase):
    def test_every_number_of_the_table_is_that_of_the_stored_result(self):
        stored = output.read_results(os.path.join(ROOT, "docs", "benchmarks", readme.STORED))
        with open(os.path.join(ROOT, "README.md"), encoding="utf-8") as text:
            shown = text.read()
        self.assertEqual(shown, readme.in_text(shown, stored))
        self.assertGreaterEqual(len(readme.table(stored)), 10)

    def test_numbers_keep_two_digits(self):
        self.assertEqual([readme.number(value) for value in (0.0789, 262.4, 1, 0, None)], ["0.079", "262", "1", "0", "-"])
        self.assertEqual(readme.number(2.85e-15), "2.9·10<sup>-15</sup>")


class Peers(unittest.TestCase):
    """What other programs are given is the frame that Topple is given."""

    FRAME = peers.Frame(3, 2, 3)
    SECTIONS = {"column": peers.COLUMN, "beam": peers.BEAM}

    def test_a_frame3dd_file_is_the_same_frame(self):
        with tempfile.TemporaryDirectory() as folder:
            peers.write_topple(self.FRAME, os.path.join(folder, "frame.json"))
            other_peers.write_frame3dd(self.FRAME, self.SECTIONS, os.path.join(folder, "frame.3dd"), peers.YOUNG, peers.SHEAR, peers.DENSITY)
            sags = []
            for name, prefix in (("frame.json", "n"), ("frame.3dd", "")):
                subprocess.run([TOPPLE, "analyse", name, "-o", "out"], cwd=folder, check=True, capture_output=True)
                with open(os.path.join(folder, "out", "results.json"), encoding="utf-8") as stored:
                    moved = next(iter(json.load(stored)["combinations"].values()))["displacements"]
                sags.append(sum(moved["%s%d" % (prefix, node)][2] for node in self.FRAME.roof))
            self.assertLess(abs(sags[0] / sags[1] - 1), 1e-12)  # rounding times the condition of a few storeys

    def test_the_memory_of_a_command_is_its_own(self):
        weight = bytearray(200 << 20)
        weight[::4096] = b"x" * len(weight[::4096])  # every page is there
        _, _, mib = peers.measured([sys.executable, "-I", "-c", "pass"], "/", dict(os.environ))
        self.assertLess(mib, 100)  # an interpreter takes some 10
        with self.assertRaisesRegex(RuntimeError, "ended with 3"):
            peers.measured([sys.executable, "-I", "-c", "raise SystemExit(3)"], "/", dict(os.environ))

    def test_each_peer_is_read_from_its_own_answer(self):
        with tempfile.TemporaryDirectory() as folder:
            here = types.SimpleNamespace(programs="", frame3dd="frame3dd", opensees="opensees")
            roofs = {name: roof for name, _, roof, _ in peers.contestants(here, self.FRAME, folder)}
            nodes = list(self.FRAME.roof)
            with open(os.path.join(folder, "frame3dd.out"), "w", encoding="utf-8") as out:
                out.write("N O D E   D I S P L A C E M E N T S\n  Node    X-dsp\n" + "".join("%d 0 0 -0.25 0 0 0\n" % node for node in nodes) + "F R A M E\n")
            self.assertEqual(roofs["Frame3DD"](), 0.25)
            with self.assertRaises(OSError):
                roofs["OpenSees"]()

    def test_a_peer_that_fails_is_left_out_and_says_why(self):
        good, bad = [sys.executable, "-I", "-c", "pass"], [sys.executable, "-I", "-c", "raise SystemExit('no such element')"]
        lines = []
        spent = peers.taken([("Topple", good, None, 99), ("other", bad, None, 99), ("once", good, None, 1)], 2, "/", dict(os.environ), lines)
        self.assertEqual({name: len(runs) for name, runs in spent.items()}, {"Topple": 2, "once": 1})
        self.assertEqual(len(lines), 1)
        self.assertIn("no such element", lines[0])
        with self.assertRaises(RuntimeError):
            peers.taken([("Topple", bad, None, 99)], 1, "/", dict(os.environ), lines)

    def test_the_roof_is_read_from_what_frame3dd_writes(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "frame.out")
            with open(path, "w", encoding="utf-8") as out:
                out.write("N O D E   D I S P L A C E M E N T S  \t\t(global)\n  Node    X-dsp       Y-dsp       Z-dsp       X-rot       Y-rot       Z-rot\n"
                          "     7    0.1         0.0        -0.25        0.0         0.0         0.0\n     8    0.1         0.0        -0.75        0.0         0.0         0.0\n"
                          "F R A M E   E L E M E N T   E N D   F O R C E S\n     8    1.0         2.0         3.0         4.0         5.0         6.0\n")
            self.assertEqual(other_peers.roof_of_frame3dd(path, [7, 8]), 0.5)
            with self.assertRaises(RuntimeError):
                other_peers.roof_of_frame3dd(path, [7, 8, 9])

    def test_an_opensees_file_has_every_member_its_load_and_the_roof(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "frame.tcl")
            other_peers.write_opensees(self.FRAME, self.SECTIONS, path, peers.YOUNG, peers.SHEAR, "roof.out")
            with open(path, encoding="utf-8") as text:
                lines = text.read().splitlines()
            count = lambda word: sum(line.startswith(word) for line in lines)
            members = len(self.FRAME.posts) + len(self.FRAME.beams)
            self.assertEqual([count("node "), count("fix "), count("element "), count("eleLoad "), count("puts ")],
                             [len(self.FRAME.nodes), self.FRAME.fixed, members, members, len(self.FRAME.roof)])


class Scaling(unittest.TestCase):
    def test_the_exponent_of_a_power_is_found_and_small_sizes_do_not_count(self):
        points = [(100, 7.0)] + [(n, 1e-6 * n**1.5) for n in (1000, 10000, 100000)]
        self.assertAlmostEqual(scaling.exponent(points), 1.5, places=12)
        self.assertIsNone(scaling.exponent(points[:3]))

    def test_several_runs_of_a_size_become_medians_with_their_spread(self):
        run = lambda once, often: {"kernel": "x", "factor_seconds": once, "idle_step_seconds": often, "idle_step_low": often / 2, "idle_step_high": 2 * often, "freedoms": 96}
        row = scaling.together([run(1.0, 5.0), run(3.0, 4.0), run(2.0, 6.0)])
        self.assertEqual(row, {"runs": 3, "kernel": "x", "factor_seconds": 2.0, "factor_low": 1.0, "factor_high": 3.0, "idle_step_seconds": 5.0, "idle_step_low": 2.0,
                               "idle_step_high": 12.0, "freedoms": 96})
        self.assertNotIn("factor_low", scaling.together([run(1.0, 5.0)]))

    def test_memory_is_foreseen_by_the_growth_of_the_last_two_sizes(self):
        rows = [{"freedoms": n, "analysis_peak_mib": n**1.2, "simulation_peak_mib": 1.0} for n in (1000, 10000)]
        self.assertAlmostEqual(scaling.needs(rows, 100000) / 100000**1.2, 1, places=9)
        self.assertEqual(scaling.needs(rows[:1], 100000), 0.0)


class Debris(unittest.TestCase):
    RUN = {"scene": "heap", "engine": "small-steps", "bodies": 5, "bits": "ab", "milliseconds": 2.0, "over_10_mm": 3, "over_20_mm": 0, "settled_at": 1.0, "rest": 4.0, "height": 1.0,
           "deepest_mm": 7.0, "asleep_force_worst": 1e-6, "asleep_force_rms": 3e-7, "created": 1e-3, "same_bits": True}

    def test_seeds_become_medians_of_times_and_the_worst_of_errors(self):
        runs = [self.RUN, dict(self.RUN, milliseconds=3.0, rest=6.0, deepest_mm=9.0, asleep_force_rms=4e-7, bits="cd"), dict(self.RUN, milliseconds=7.0, rest=5.0, created=None, asleep_force_rms=0.0)]
        row = debris.together(runs)
        self.assertEqual([row[key] for key in ("seeds", "milliseconds", "low", "high", "rest", "deepest_mm", "created", "bits", "same_bits")], [3, 3.0, 2.5, 5.0, 5.0, 9.0, 1e-3, "ab", "yes"])
        self.assertAlmostEqual(row["asleep_force_rms"], 5e-7 / 3**0.5)

    def test_what_stays_awake_once_has_no_time_of_rest_and_is_named(self):
        row = debris.together([self.RUN, dict(self.RUN, rest=None)])
        self.assertIsNone(row["rest"])
        self.assertIn("not all asleep in the end: heap", debris.verdict([row])[0])

    def test_one_run_that_differs_is_told(self):
        self.assertEqual(debris.together([self.RUN, dict(self.RUN, same_bits=False)])["same_bits"], "no")


class Labels(unittest.TestCase):
    def test_labels_of_points_at_one_place_do_not_cover_each_other(self):
        x_range, y_range = (1e-3, 1e3), (1e-16, 1e2)
        placed = labels.place([("one label", 1.0, 1e-3), ("another", 1.0, 1e-3), ("a third", 1.1, 1e-3)], x_range, y_range)
        heights = sorted(labels.HEIGHT * math.log10(y / y_range[0]) / 18 for _, _, y, _, _ in placed)
        self.assertTrue(all(b - a >= labels.LINE for a, b in zip(heights, heights[1:])), heights)


class Convergence(unittest.TestCase):
    def judged(self, later, down=8):
        """Half of it is down at the same instants, or so much later in the finer steps, told as the step's beginning."""
        found = {}
        for k in range(40):
            for rate, shift in ((60, 0.0), (240, later)):
                found["house", rate, k] = {"down": down, "half": math.floor((1.31 + 0.0071 * k + shift) * rate) / rate}
        one = types.SimpleNamespace(broken=[])
        lines = convergence.judge(one, convergence.STEPS, ["house"], {"house": 10}, found, {"house": 40}, random.Random(1))
        self.assertEqual(one.broken, [])
        return lines[-1]

    def test_times_are_compared_as_the_longer_steps_tell_them(self):
        self.assertIn("p = 1.000", self.judged(0.0))
        self.assertIn("MISSED", self.judged(0.02))

    def test_times_are_those_of_collapses(self):
        self.assertIn("p = 1.000", self.judged(0.02, down=5))


class Constants(unittest.TestCase):
    """With a program in the place of bench_constants whose collapses hang on one constant of two."""

    PROGRAM = """#!%s
import json, sys
if sys.argv[1] == "--list":
    print("impact.first 1\\nimpact.second 2")
    sys.exit(0)
if sys.argv[2:] == ["impact.second", "2"]:
    sys.exit("it failed")
with open(sys.argv[1]) as stored:
    y = json.load(stored)["events"][0]["projectile"]["from"][1]
share = 0.5 + 0.1 * y + (0.25 if sys.argv[2:] == ["impact.first", "0.5"] else 0)
print(json.dumps({"share": share, "half": 2.0}))
"""

    def test_it_tells_what_hangs_on_a_constant_from_what_does_not(self):
        with tempfile.TemporaryDirectory() as folder:
            program = os.path.join(folder, "bench_constants")
            with open(program, "w", encoding="utf-8") as out:
                out.write(self.PROGRAM % sys.executable)
            os.chmod(program, 0o755)
            one = context(folder)
            one.root, one.programs, one.quick, one.start, one.broken = ROOT, folder, False, 0.0, []
            one.scenarios, one.samples = ["house_hit"], 8
            with contextlib.redirect_stdout(io.StringIO()):
                constants.run(one)
            rows = {(row["constant"], row["factor"]): row for row in output.read_results(os.path.join(folder, "constants.json"))["rows"]}
            self.assertEqual(set(rows), {("impact.first", 0.5), ("impact.first", 2), ("impact.second", 0.5), ("impact.second", 2)})
            self.assertAlmostEqual(rows["impact.first", 0.5]["change"], 0.25)
            self.assertGreater(rows["impact.first", 0.5]["low"], 0)
            self.assertAlmostEqual(rows["impact.first", 2]["change"], 0)
            self.assertEqual(rows["impact.second", 2]["failed"], 8)
            self.assertEqual(len(one.broken), 1)

    def test_its_constants_are_those_of_the_page(self):
        with tempfile.TemporaryDirectory() as folder:
            table = os.path.join(folder, "table.inc")
            subprocess.run([sys.executable, os.path.join(ROOT, "scripts", "constants"), "--table", table], check=True)
            with open(table, encoding="utf-8") as text:
                told = {line.split('"')[1].split(".")[1] for line in text}
        with open(os.path.join(ROOT, "docs", "constants.md"), encoding="utf-8") as page:
            cells = [line.split("|")[1] for line in page if line.startswith("| `")]
        self.assertEqual(told, {name.strip(" `") for cell in cells for name in cell.split(",")})


if __name__ == "__main__":
    unittest.main()
