#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""tools/lab/claims.py: faults of a table name file and row; figures are found where the tables say;
verdicts follow the figures and the tests; and the whole register with few runs, from end to end."""
import json
import pathlib
import subprocess
import unittest

import lab_test_setup

lab_test_setup.need_packages("rhotrack")

import claims
from parts import claims_figures
from parts import read_claims as table
import numpy as np

SCRIPT = lab_test_setup.ROOT / "tools" / "lab" / "claims.py"
PAPER = "[paper]\ntitle = A paper\nby = Someone\nrows = equation 1-2\n"
SEE = "[see A]\nwhat = it\ncommand = rhotrack --version\ncode = src/papers/hough\n"
CODE = "code = src/papers/hough.c rho_hough_find\n"
TEST = "test = tests/unit/papers/test_hough.c the_three_targets_of_table_1_have_the_most_votes\n"
SET = "[equation 1]\nsays = a set\ndefinition = of set theory\n"
MEASURED = ("[equation 2]\nsays = less than one\n" + CODE
            + "measured = ht, nht: lab cases[case=I, thin;method=HT|NHT].votes\n"
            "shown = {ht:.1f}, {nht:.1f}\nholds = nht < 1\nwhy = noise\n"
            "at = a noise of {} m: lab noise by noise_m^2\nat_measured = x: [method=NHT].votes\n"
            "at_holds = x < 1\n")
FIGURES = {"lab": {
    "cases": [{"case": "I, thin", "method": "HT", "votes": 2.0},
              {"case": "I, thin", "method": "NHT", "votes": 3}],
    "noise": [{"noise_m": 0.5, "method": "NHT", "votes": 0.5},
              {"noise_m": 3.0, "method": "NHT", "votes": 0.75},
              {"noise_m": 9.0, "method": "NHT", "votes": 4.0}]}}


class Tables(unittest.TestCase):
    def read(self, text, with_numbers=PAPER):
        with lab_test_setup.folder() as folder:
            (folder / "paper.ini").write_text(with_numbers + text)
            return table.read_all(folder)[0]

    def test_rows_are_read(self):
        paper = self.read(SEE + SET + MEASURED)
        self.assertEqual(paper.see, [("A", "it", "rhotrack --version", ["src/papers/hough"])])
        row = paper.rows[1]
        self.assertEqual(row.code, [("src/papers/hough.c", "rho_hough_find")])
        self.assertEqual(row.measured, [
            ("ht", "lab", "cases[case=I, thin;method=HT].votes"),
            ("nht", "lab", "cases[case=I, thin;method=NHT].votes")])
        self.assertEqual(row.at, ("a noise of {} m", "lab", "noise", "noise_m", 2))

    def test_faults_name_file_and_row(self):
        for text, wanted in (
                (SET, r"paper.ini: no row equation 2"),
                (SET + MEASURED + "sais = typing\n", r"paper.ini: \[equation 2\]: no key sais"),
                (SET + "[equation 2]\n" + CODE + TEST, r"\[equation 2\]: says nothing"),
                (SET + "[equation 2]\nsays = so\n" + CODE, "neither figures nor code and test"),
                (SET + "[equation 2]\nsays = so\ncode = src/papers/hough.c\n" + TEST,
                 r"\[equation 2\]: code is FILE NAME, not `src/papers/hough.c`"),
                (SET + MEASURED.replace("holds = nht < 1", "holds = iht < 1"),
                 r"\[equation 2\]: holds: no figure iht"),
                (SET + MEASURED.replace("holds = nht < 1", "holds = nht <"), "no expression"),
                (SET + MEASURED.replace("{nht:.1f}", "{mht:.1f}"), "shown: no figure mht"),
                (SET + MEASURED.replace("holds = nht < 1\n", ""), "does not say when it holds"),
                (SET + MEASURED + "lost = the page\n", "has holds and lost"),
                (SET + "[equation 2]\nsays = so\ndiffers = so\n" + CODE, "code or test alone"),
                (SET + MEASURED.replace("ht, nht: lab", "ht nht lab"), "measured is NAME"),
                (SET + MEASURED.replace("HT|NHT", "HT|NHT|MHT"), "2 names of 3 figures"),
                (SET + MEASURED.replace(" by noise_m^2", ""), "at is TEXT"),
                (SET + MEASURED + "[equation 2]\nsays = twice\n", "paper.ini.*already exists"),
                (SET + MEASURED + "[see B]\nwhat = it\n", r"\[see B\]: has what, command")):
            with self.assertRaisesRegex(table.Fault, wanted):
                self.read(text)
        with self.assertRaisesRegex(table.Fault, r"paper.ini: \[paper\]: no rows"):
            self.read(SET, "[paper]\ntitle = A\nby = B\n")

    def test_figures_are_where_the_tables_say(self):
        row = self.read(SET + MEASURED).rows[1]
        self.assertEqual([table.figure(row, FIGURES, *of[1:]) for of in row.measured], [2.0, 3])
        for path in ("cases[case=I;method=HT].votes", "cases[method=HT].vote", "cases[2].votes",
                     "cases[case=I, thin].votes"):
            with self.assertRaisesRegex(table.Fault, r"paper.ini: \[equation 2\]: no figure lab"):
                table.figure(row, FIGURES, "lab", path)
        with self.assertRaisesRegex(table.Fault, "no number"):
            table.figure(row, FIGURES, "lab", "cases[0].case")

    def test_the_tables_of_the_register_hold(self):
        papers = table.read_all()
        self.assertEqual(len(papers), 3)
        self.assertGreater(sum(len(paper.rows) for paper in papers), 170)


class Verdicts(unittest.TestCase):
    def judged(self, text, figures=FIGURES, passed=True):
        with lab_test_setup.folder() as folder:
            (folder / "paper.ini").write_text(PAPER + SET + text)
            row = table.read_all(folder)[0].rows[1]
        return claims.judged_row(row, figures, {test: passed for test in row.test})

    def test_figures_decide(self):
        self.assertEqual(self.judged(MEASURED), (
            "fails", "2.0, 3.0", "noise; holds at a noise of 0.25, 9 m"))
        self.assertEqual(self.judged(MEASURED.replace("nht < 1", "nht == 3"))[0], "holds")
        self.assertEqual(self.judged(MEASURED.replace("x < 1", "x < 0"))[2],
                         "noise; does not at a noise of 0.25, 9, 81 m either")

    def test_a_figure_that_no_run_has_is_not_measured(self):
        figures = json.loads(json.dumps(FIGURES))
        figures["lab"]["cases"][1]["votes"] = None
        self.assertEqual(self.judged(MEASURED, figures)[0], "not measured")

    def test_tests_decide_where_there_are_no_figures(self):
        tested = "[equation 2]\nsays = so\n" + CODE + TEST
        self.assertEqual(self.judged(tested), ("holds", "1 of 1 tests pass", ""))
        self.assertEqual(self.judged(tested, passed=False)[0], "fails")
        self.assertEqual(self.judged(tested + "lost = the page\n"),
                         ("cannot be known", "1 of 1 tests pass", "lost: the page"))
        self.assertEqual(self.judged(tested + "differs = half of it\n"),
                         ("differs", "1 of 1 tests pass", "half of it"))
        self.assertEqual(self.judged(tested + "differs = half of it\n", passed=False)[0], "fails")
        self.assertEqual(self.judged("[equation 2]\nsays = so\ndiffers = nothing computes it\n"),
                         ("differs", "", "nothing computes it"))

    def test_tests_are_run(self):
        c, python = "tests/unit/papers/test_votes_picture.c", "tests/lab/test_claims.py"
        self.assertEqual(claims.results_in_c([c])[c, "windows_beyond_the_plane_are_refused"], True)
        test = "test_crossings_are_counted"
        self.assertEqual(claims.results_in_python({(python, test)}), {(python, test): True})


class Own(unittest.TestCase):
    def test_crossings_are_counted(self):
        paths = np.array([[[0, 0], [0, 4], [0, 9]], [[2, 2], [2, 1], [2, 9]],
                          [[4, 4], [4, 0], [4, 9]]], float)
        self.assertEqual(claims_figures.crossings(paths), 1)

    def test_printed_lines_are_as_wrong_as_they_are_told(self):
        """A pair on x = y: alpha is 1, theta printed -pi/4; the line's normal has 3 pi/4."""
        told = claims_figures.equation_9()
        self.assertEqual(told["printed_in_range"], 0)
        self.assertAlmostEqual(told["printed_right"] + told["absolute_right"], 1, places=3)


class EndToEnd(unittest.TestCase):
    def run_it(self, *arguments):
        return subprocess.run([str(SCRIPT), *map(str, arguments)], capture_output=True, text=True,
                              check=False)

    def test_a_bad_table_ends_it(self):
        with lab_test_setup.folder() as folder:
            (folder / "paper.ini").write_text(PAPER + SET + "[equation 2]\nsays = so\n")
            done = self.run_it("--tables", folder, "-o", folder / "out")
            self.assertEqual(done.returncode, 1)
            self.assertIn("paper.ini: [equation 2]: has neither", done.stderr)

    def test_the_whole_register(self):
        with lab_test_setup.folder() as folder:
            done = self.run_it("--runs", 2, "--json", "-o", folder)
            self.assertEqual(done.returncode, 0, done.stderr)
            told = json.loads(done.stdout)
            page = (folder / "CLAIMS.md").read_text()
            kept = (lab_test_setup.ROOT / "tools/lab/CLAIMS.md").read_text()
            rows = [line.split(" | ")[0] for line in page.splitlines() if line.startswith("| ")]
            self.assertEqual(rows, [line.split(" | ")[0] for line in kept.splitlines()
                                    if line.startswith("| ")])
            self.assertEqual(sum(told[verdict] for verdict in claims.VERDICTS),
                             sum(len(paper.rows) for paper in table.read_all()))
            self.assertGreater(told["holds"], 80)
            self.assertGreater(told["fails"], 20)  # what two runs tell is not sure
            self.assertEqual(told["cannot be known"], page.count("**cannot be known**"))
            for name in ("papers-initiation", "passive", "maneuver"):
                self.assertTrue(pathlib.Path(folder / name / "figures.json").exists())


if __name__ == "__main__":
    lab_test_setup.main()
