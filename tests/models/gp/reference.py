"""Log marginal likelihood, its gradient, mean and variance by scikit-learn, for reference_test.cpp.

Reads a case as JSON from stdin: kernel terms, samples, points; writes the numbers as JSON to stdout.
"""
import json
import sys

import numpy as np
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import RBF, ConstantKernel, ExpSineSquared, Kernel, WhiteKernel


class OnInput(Kernel):
    """A kernel of one column of its inputs."""

    def __init__(self, kernel, column):
        self.kernel = kernel
        self.column = column

    def __call__(self, X, Y=None, eval_gradient=False):
        pick = lambda Z: None if Z is None else Z[:, [self.column]]
        return self.kernel(pick(X), pick(Y), eval_gradient=eval_gradient)

    def diag(self, X):
        return self.kernel.diag(X[:, [self.column]])

    def is_stationary(self):
        return True

    @property
    def theta(self):
        return self.kernel.theta

    @theta.setter
    def theta(self, theta):
        self.kernel.theta = theta

    @property
    def bounds(self):
        return self.kernel.bounds

    @property
    def hyperparameters(self):
        return self.kernel.hyperparameters

    def clone_with_theta(self, theta):
        return OnInput(self.kernel.clone_with_theta(theta), self.column)


def shape(entry, column):
    if entry["kind"] == "periodic":
        # The exponent is -2 sin²(πr/p)/l², as in Loopwright.
        return OnInput(ExpSineSquared(entry["length"], entry["period"], periodicity_bounds="fixed"), column)
    return OnInput(RBF(entry["length"]), column)


case = json.load(sys.stdin)
kernel = None
for term in case["terms"]:
    product = ConstantKernel(term["deviation"] ** 2)
    for column, entry in enumerate(term["along"]):
        if entry["kind"] != "constant":
            product = product * shape(entry, column)
    kernel = product if kernel is None else kernel + product
kernel = kernel + WhiteKernel(case["noise"] ** 2)

X, y = np.array(case["inputs"]), np.array(case["labels"])
model = GaussianProcessRegressor(kernel, alpha=0, optimizer=None).fit(X, y)
value, gradient = model.log_marginal_likelihood(model.kernel_.theta, eval_gradient=True, clone_kernel=False)
mean, deviation = model.predict(np.array(case["points"]), return_std=True)
# scikit-learn differentiates with respect to the logarithm of variances; for a standard deviation the value is twice that.
free = [h.name for h in model.kernel_.hyperparameters if not h.fixed]
is_variance = ["constant_value" in name or "noise_level" in name for name in free]
gradient = [g * 2 if v else g for g, v in zip(gradient, is_variance)]
json.dump({"value": value, "gradient": list(gradient), "mean": list(mean),
           "variance": list(deviation ** 2 - case["noise"] ** 2)}, sys.stdout)
