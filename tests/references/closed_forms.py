#!/usr/bin/env python3
"""Closed forms that `ctpm fidelity` compares with: python3 closed_forms.py

Material: E = 39270 Pa and nu = 1/4 at rest; G(t) = G(inf) (1 + exp(-t / tau)), tau = v1 / (K1 + K2) = 5 / (15 + 15) s,
the shipped liver's: a triple holds a spring K2 in series with a Kelvin unit K1, v1; before the dashpot yields it has
the stiffness K2, at rest K1 K2 / (K1 + K2), half of it.
"""
import math

from scipy.integrate import quad

E, NU, TAU = 39270.0, 0.25, 5 / (15 + 15)  # Pa, 1, s


def bar(strain, side):
    """Force [N] of a bar of square section, side [m], at a strain along its axis."""
    return E * strain * side ** 2


def hertz(radius, depth):
    """Force [N] of a half space on a rigid ball (H. Hertz 1882), lengths in m."""
    return 4 / 3 * E / (1 - NU ** 2) * math.sqrt(radius) * depth ** 1.5


def lee_radok(ramp):
    """F(ramp) / F(inf) of a ball that enters a viscoelastic half space evenly for `ramp` s and stays
    (E. H. Lee, J. R. M. Radok, J. Appl. Mech. 27, 1960): F(t) = F1 int G(t - s) / G(inf) d(depth(s)^1.5)."""
    grown = quad(lambda s: math.exp(-(ramp - s) / TAU) * 1.5 * math.sqrt(s) / ramp ** 1.5, 0, ramp, epsabs=1e-13)[0]
    return 1 + grown


if __name__ == "__main__":
    print(f"bar 48 x 48 mm at 1 %: {bar(0.01, 0.048):.9f} N")
    for depth in (1, 2, 4):
        print(f"Hertz, R 20 mm, {depth} mm: {hertz(0.02, 1e-3 * depth):.9f} N")
    for ramp in (5, 50, 500):
        print(f"Lee & Radok, ramp {ramp} ms: {lee_radok(1e-3 * ramp):.9f}")
