#!/usr/bin/env python3
"""Sag of a cantilever under its own weight, with CalculiX: python3 cantilever.py [FOLDER]

Beam 24 x 24 x 120 mm along x, E = 39270 Pa, nu = 1/4, 1060 kg/m^3, gravity 0.0981 m/s^2 along -z. All material with
x <= 12 mm is clamped: every node there has no displacement. The sag is the displacement along -z of the middle of the
end face (x = 120 mm). Geometrically linear. Half the beam is meshed (y >= 0) with symmetry at y = 0.
"""
import sys

from hexahedra import Box, even, node_set, numbers_after, run

E, NU, DENSITY, GRAVITY = 0.03927, 0.25, 1060e-12, 98.1  # MPa, 1, t/mm^3, mm/s^2


def sag(folder, size):
    """Sag [mm] with elements of about `size` mm."""
    box = Box(even(0, 12, round(12 / size)) + even(12, 120, round(108 / size))[1:], even(0, 12, round(12 / size)),
              even(-12, 12, round(24 / size)))
    tip = box.nodes(lambda x, y, z: abs(x - 120) < 1e-6 and abs(y) < 1e-6 and abs(z) < 1e-6)
    assert len(tip) == 1
    lines = box.deck()
    lines += node_set("CLAMPED", box.nodes(lambda x, y, z: x < 12 + 1e-6))
    lines += node_set("MIRROR", box.nodes(lambda x, y, z: abs(y) < 1e-6))
    lines += node_set("TIP", tip)
    lines += ["*MATERIAL, NAME=TISSUE", "*ELASTIC", f"{E}, {NU}", "*DENSITY", f"{DENSITY}",
              "*SOLID SECTION, ELSET=BODY, MATERIAL=TISSUE",
              "*BOUNDARY", "CLAMPED, 1, 3", "MIRROR, 2, 2",
              "*STEP", "*STATIC", "*DLOAD", f"BODY, GRAV, {GRAVITY}, 0., 0., -1.",
              "*NODE PRINT, NSET=TIP", "U", "*END STEP"]
    text = run(folder, f"cantilever_{size:g}", lines)
    return -numbers_after(text, "displacements")[0][0][3]


if __name__ == "__main__":
    where = sys.argv[1] if len(sys.argv) > 1 else "/tmp/ctpm-references"
    for step in (6, 4, 2):
        print(f"elements of {step} mm: sag {sag(where, step):.6f} mm", flush=True)
