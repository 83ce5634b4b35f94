#!/usr/bin/env python3
"""Force of a block on a rigid ball that presses it without friction, with CalculiX: python3 indentation.py [FOLDER]

Block 96 x 96 x 60 mm, E = 39270 Pa, nu = 1/4, its bottom held in all directions, sides and top free. A rigid ball of
radius 20 mm presses the middle of the top by 1, 2 and 4 mm. Geometrically linear (no NLGEOM): small strains of the
tissue, exact shape of the ball. A quarter is meshed (x, y >= 0) with symmetry at both planes.

The ball is a cap of C3D20R elements whose nodes are all prescribed. Contact is CalculiX's surface-to-surface penalty
with PENALTY MPa per mm of penetration; "penalty x 2" shows what doubling it changes. The check `hertz` presses a block
of 320 x 320 x 160 mm by 0.25 mm and compares with Hertz. "large strains" is NLGEOM, for information: the law of St.
Venant and Kirchhoff, which is softer in compression.
"""
import math
import sys

from hexahedra import Box, even, graded, node_set, numbers_after, run

E, NU, RADIUS = 0.03927, 0.25, 20.0  # MPa, 1, mm
PENALTY = 1.0  # MPa/mm: pressures are about 0.005 MPa, so the ball sinks in by about 0.005 mm


def cap(reach, size):
    """A cap of the ball, 4 mm thick, over the square [0, reach]^2, its lowest point at the origin."""
    planes = even(0, reach, round(reach / size))
    box = Box(planes, planes, [0, 4])
    box.place = {n: (x, y, z + RADIUS - math.sqrt(RADIUS ** 2 - x * x - y * y)) for n, (x, y, z) in box.place.items()}
    return box


def forces(folder, name, half, height, depths, reach, size, penalty=PENALTY, growth=1.35, nlgeom=False):
    """Forces [N] at the depths [mm]; elements of `size` mm where the ball may touch (within `reach` mm)."""
    across = graded(0, reach, half, size, growth)
    down = [-z for z in reversed(graded(0, reach / 2, height, size, growth))]
    block, ball = Box(across, across, down), cap(reach, size * 0.7)
    lines = block.deck() + ball.deck(len(block.place), len(block.element), "BALL")
    lines += node_set("BOTTOM", block.nodes(lambda x, y, z: z < 1e-6 - height))
    lines += node_set("MIRROR_X", block.nodes(lambda x, y, z: abs(x) < 1e-6))
    lines += node_set("MIRROR_Y", block.nodes(lambda x, y, z: abs(y) < 1e-6))
    lines += node_set("CAP", [n + len(block.place) for n in ball.place])
    touched = block.top_elements(lambda x, y, z: max(x, y) < reach)
    lines += ["*SURFACE, NAME=TOP"] + [f"{e}, S2" for e in touched]
    lines += ["*SURFACE, NAME=UNDER"] + [f"{e + len(block.element)}, S1" for e in ball.element]
    lines += ["*MATERIAL, NAME=TISSUE", "*ELASTIC", f"{E}, {NU}",
              "*SOLID SECTION, ELSET=BODY, MATERIAL=TISSUE", "*SOLID SECTION, ELSET=BALL, MATERIAL=TISSUE",
              "*SURFACE INTERACTION, NAME=SLIDING", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{penalty}",
              "*CONTACT PAIR, INTERACTION=SLIDING, TYPE=SURFACE TO SURFACE", "TOP, UNDER",
              "*BOUNDARY", "BOTTOM, 1, 3", "MIRROR_X, 1, 1", "MIRROR_Y, 2, 2", "CAP, 1, 2"]
    for depth in depths:
        lines += ["*STEP, INC=1000" + (", NLGEOM" if nlgeom else ""), "*STATIC", "0.5, 1.",
                  "*BOUNDARY", f"CAP, 3, 3, {-depth}", "*NODE PRINT, NSET=BOTTOM, TOTALS=ONLY, FREQUENCY=1000",
                  "RF", "*END STEP"]
    text = run(folder, name, lines)
    tables = numbers_after(text, "total force")
    assert len(tables) == len(depths), text[-2000:]
    return [4 * rows[0][2] for rows in tables]


def hertz(depth):
    return 4 / 3 * E / (1 - NU ** 2) * math.sqrt(RADIUS) * depth ** 1.5


if __name__ == "__main__":
    where = sys.argv[1] if len(sys.argv) > 1 else "/tmp/ctpm-references"
    checked = forces(where, "hertz", 160, 160, [0.25], 4, 0.5, growth=1.6)[0]
    print(f"hertz, 0.25 mm: {checked:.6f} N, closed form {hertz(0.25):.6f} N", flush=True)
    for step in (2.4, 1.5):
        name = f"indentation_{step:g}"
        print(f"elements of {step} mm:", forces(where, name, 48, 60, [1, 2, 4], 12, step), flush=True)
    print("penalty x 2:", forces(where, "penalty", 48, 60, [1, 2, 4], 12, 2.4, 2 * PENALTY), flush=True)
    print("large strains:", forces(where, "nlgeom", 48, 60, [1, 2, 4], 12, 2.4, nlgeom=True), flush=True)
