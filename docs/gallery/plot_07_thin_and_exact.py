"""
The thin layer and the exact one
================================

The thin-layer equation is an expansion in h/a. `model_error` tells how far it is from the exact layer,
without solving that.
"""

import matplotlib.pyplot as plt
import numpy as np

import roughcoat as rc

ratio = np.geomspace(0.01, 1, 21)
own = {"a": 0.03, "h": 0.03 * ratio, "n": 0.1, "nu1": 0.4, "bonding": "frictionless", "micro": "smooth", "x": 2}
thin, exact = rc.solve(**own, base="thin_layer"), rc.solve(**own, base="layered")

# %%
error = abs(thin.P / exact.P - 1)
estimate = thin.model_error
assert error[0] < 0.02 and (estimate[:10] > 0.3 * error[:10]).all()

figure, axes = plt.subplots(figsize=(6, 4))
axes.loglog(ratio, error, label="error of P")
axes.loglog(ratio, estimate, "--", label="model_error, of all results")
axes.set(xlabel="h/a", ylabel="relative error")
axes.legend()
