"""Boxes of 20-node hexahedra for CalculiX (C3D20R): the mesh, its node sets and the run.

Lengths in mm, forces in N, stresses in MPa, densities in t/mm^3: a consistent set of units for CalculiX.
"""
import itertools
import pathlib
import re
import subprocess


class Box:
    """A box of nx x ny x nz elements between the planes `x`, `y` and `z` (ascending coordinates of element faces)."""

    def __init__(self, x, y, z):
        self.counts = [len(x) - 1, len(y) - 1, len(z) - 1]
        grid = [refined(x), refined(y), refined(z)]
        self.node = {}  # (i, j, k) on the grid of half elements -> number
        self.place = {}  # number -> coordinates
        for k, j, i in itertools.product(*(range(len(g)) for g in reversed(grid))):
            if i % 2 + j % 2 + k % 2 > 1:
                continue  # serendipity: corners and the middles of edges
            number = len(self.node) + 1
            self.node[i, j, k] = number
            self.place[number] = (grid[0][i], grid[1][j], grid[2][k])
        self.element = {}
        for k, j, i in itertools.product(*(range(n) for n in reversed(self.counts))):
            self.element[len(self.element) + 1] = [self.node[2 * i + a, 2 * j + b, 2 * k + c] for a, b, c in CORNERS]

    def nodes(self, condition):
        return [n for n, p in self.place.items() if condition(*p)]

    def top_elements(self, condition):
        """Elements of the uppermost layer whose top face's centre meets the condition."""
        first = self.counts[0] * self.counts[1] * (self.counts[2] - 1)
        chosen = []
        for number in range(first + 1, len(self.element) + 1):
            corners = [self.place[n] for n in self.element[number][4:8]]
            if condition(*(sum(c[a] for c in corners) / 4 for a in range(3))):
                chosen.append(number)
        return chosen

    def deck(self, first_node=0, first_element=0, name="BODY"):
        lines = ["*NODE"]
        lines += [f"{n + first_node}, {p[0]:.9g}, {p[1]:.9g}, {p[2]:.9g}" for n, p in self.place.items()]
        lines += [f"*ELEMENT, TYPE=C3D20R, ELSET={name}"]
        for e, corners in self.element.items():
            numbers = [str(n + first_node) for n in corners]
            lines += [f"{e + first_element}, " + ", ".join(numbers[:15]) + ",", ", ".join(numbers[15:])]
        return lines


# Order of CalculiX: corners below, corners above, edges below, edges above, upright edges.
CORNERS = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2),
           (1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2),
           (0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1)]


def refined(planes):
    """The planes and the middles between them."""
    middle = [(a + b) / 2 for a, b in zip(planes, planes[1:])]
    return [p for pair in zip(planes, middle + [None]) for p in pair if p is not None]


def even(first, last, count):
    return [first + (last - first) * i / count for i in range(count + 1)]


def graded(first, fine_to, last, step, growth):
    """Planes `step` apart up to `fine_to`, then further and further apart, ending at `last`."""
    planes = even(first, fine_to, round((fine_to - first) / step))
    size = step
    while planes[-1] < last:
        size *= growth
        planes.append(planes[-1] + size)
    scale = (last - fine_to) / (planes[-1] - fine_to)
    return [p if p <= fine_to else fine_to + (p - fine_to) * scale for p in planes]


def node_set(name, numbers):
    return [f"*NSET, NSET={name}"] + [f"{n}," for n in numbers]


def run(folder, name, lines):
    """Runs CalculiX on a deck and returns the text of its table of results (.dat)."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{name}.inp").write_text("\n".join(lines) + "\n")
    done = subprocess.run(["ccx", "-i", name], cwd=folder, capture_output=True, text=True)
    if done.returncode != 0 or "Job finished" not in done.stdout:
        raise RuntimeError(f"{name}: CalculiX failed\n{done.stdout[-3000:]}{done.stderr[-1000:]}")
    return (folder / f"{name}.dat").read_text()


def numbers_after(text, title):
    """Rows of numbers below each line that begins with `title`: one list of rows for each time."""
    tables = []
    for part in re.split(rf"^ *{title}[^\n]*\n", text, flags=re.M)[1:]:
        rows = []
        for line in part.splitlines():
            if not line.strip():
                if rows:
                    break
                continue
            try:
                rows.append([float(word) for word in line.split()])
            except ValueError:
                break
        tables.append(rows)
    return tables
