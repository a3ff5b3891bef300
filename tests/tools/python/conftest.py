"""Tests of the Python module. The program is the reference: the module must give the same numbers."""
import pathlib
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[3]


def pytest_addoption(parser):
    parser.addoption("--program", help="the program loopwright of the same build")
    parser.addoption("--generator", help="the program hidden_effects of the same build")


@pytest.fixture(scope="session")
def root():
    return ROOT


@pytest.fixture(scope="session")
def common_job():
    return ROOT / "diagrams" / "linear_motor" / "common_job.json"


@pytest.fixture(scope="session")
def program(request):
    """Runs the program and returns its standard output."""
    def call(*arguments):
        return subprocess.run([request.config.getoption("--program"), *map(str, arguments)], check=True,
                              capture_output=True, text=True).stdout
    return call


@pytest.fixture(scope="session")
def axis(request, tmp_path_factory):
    """Records of an axis with hidden viscous friction, by the generator that shares nothing with the product."""
    folder = tmp_path_factory.mktemp("axis")
    subprocess.run([request.config.getoption("--generator"), "7", folder, "paper", "viscous_friction"], check=True,
                   capture_output=True)
    return folder
