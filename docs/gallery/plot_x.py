"""
A contact
=========

Text.
"""

import matplotlib.pyplot as plt

import roughcoat as rc

c = rc.solve(P=1e-5, base="half_space", micro="smooth")
plt.plot(c.x, c.p)
