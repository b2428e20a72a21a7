#!/usr/bin/env python3
"""SPCTRAL2 by pvlib for the figures in src/sky/spectrum/tests.rs: benches/peers/spectrum_pvlib.py

With the inputs of Lightvein's own formulas: Kasten's air mass as Preetham prints it, 0.35 cm of ozone, 2 cm of water, the
aerosol's exponent 1.3 and its depth by turbidity, 1013 hPa, albedo 0.2, E0 of day 94. Prints elevation (degrees), turbidity,
the integrals of beam and diffuse by the trapezoid (W/m2), and beam and diffuse at 400, 550, 940 (between 937 and 948)
and 1600 nm (between 1592 and 1610), W/(m2 um). Needs pvlib 0.16.1 and numpy.
"""
import numpy as np
import pvlib
from pvlib.spectrum import spectrl2

DAY = 94
print("E0", pvlib.irradiance.get_extra_radiation(DAY, method="spencer", solar_constant=1))
for elevation in (90.0, 60.0, 30.0, 10.0, 3.0):
    for turbidity in (2.0, 3.0, 5.0, 10.0):
        zenith = 90.0 - elevation
        mass = 1 / (np.cos(np.radians(zenith)) + 0.15 * (93.885 - zenith) ** -1.253)
        depth = (0.04608 * turbidity - 0.04586) * 0.5**-1.3
        found = spectrl2(zenith, 0, 0, 0.2, 101300, mass, 2.0, 0.35, depth, dayofyear=DAY, alpha=1.3)
        um = found["wavelength"] / 1000
        beam, diffuse = (np.ravel(found[name]) * 1000 for name in ("dni", "dhi"))
        at = [f"{np.interp(w, um, values):.6g}" for values in (beam, diffuse) for w in (0.4, 0.55, 0.94, 1.6)]
        print(f"({elevation}, {turbidity}, {np.trapezoid(beam, um):.6g}, {np.trapezoid(diffuse, um):.6g}, "
              f"[{', '.join(at[:4])}], [{', '.join(at[4:])}]),")
