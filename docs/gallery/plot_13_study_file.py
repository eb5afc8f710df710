"""
A study, run and drawn
======================

A study is a text file. It is run once; after an edit only new contacts are computed.
"""

import tempfile
from pathlib import Path

import roughcoat as rc

folder = Path(tempfile.mkdtemp())
(folder / "soft.toml").write_text("""
title = "Soft coatings"
[model]
Nbar = 250000
Ra = 0.004
h = 0.02
bonding = "bonded"
[axes]
n = [0.1, 0.3, 0.9]
P = { start = 1e-6, stop = 1e-4, num = 11, spacing = "log" }
""")
study = rc.load(folder / "soft.toml", folder / "results")
study.run(workers=1)
contacts = study.open()

# %%
# The softer the coating is, the lower the real pressure.
assert (contacts.p_max.diff("n") > 0).all() and (contacts.status == 0).all()

figure = rc.plot(contacts, "P", "p_max", hue="n")
figure
