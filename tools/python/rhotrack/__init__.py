# SPDX-License-Identifier: MIT
"""rhotrack: tracks from radar plots and bearings::

    import rhotrack
    settings = rhotrack.Settings(sigma_m=5, v_max_mps=12, accel_max_mps2=0.5)
    scans = rhotrack.read("plots.csv", settings=settings)
    tracks = rhotrack.Tracker(settings).run(scans)
    rhotrack.plot(scans, tracks)

Scans and tracks are numpy structured arrays; their fields are the columns of the program's CSV
files. Metres, seconds and radians, x east, y north, z up; angles counter-clockwise from east.
"""
from ._core import Error
from .files import convert, write
from .filters import Ghosts, HoughGate, Imm, InputEstimation, Kalman, ghosts
from .initiation import Accumulator, Initiator, Passive
from .pictures import plot
from .scans import Scans, read, to_pandas, to_polars
from .settings import Settings, parameters
from .tracking import Maintainer, Node, Tracker, Tracks

__version__ = "0.9.0"
__all__ = [
    "Accumulator", "Error", "Ghosts", "HoughGate", "Imm", "Initiator", "InputEstimation", "Kalman",
    "Maintainer", "Node", "Passive", "Scans", "Settings", "Tracker", "Tracks", "convert", "ghosts",
    "parameters", "plot", "read", "to_pandas", "to_polars", "write"]
