# SPDX-License-Identifier: MIT
"""MCAP, the recordings of ROS 2 and Foxglove: radar_msgs, and scenes to look at.

Scans are radar_msgs/RadarScan in the frame of their sensor, tracks radar_msgs/RadarTracks in the
frame map; foxglove.FrameTransform says where sensors are.
"""
from __future__ import annotations

import os
import re
import struct
from typing import Any, Iterator

import numpy as np

from ._core import Error
from .scans import TRACK, Scans, field, polar_of

HEADER = """
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
================================================================================
"""
SCAN = "std_msgs/Header header\nRadarReturn[] returns" + HEADER + """MSG: radar_msgs/RadarReturn
float32 range
float32 azimuth
float32 elevation
float32 doppler_velocity
float32 amplitude
"""
TRACKS = "std_msgs/Header header\nRadarTrack[] tracks" + HEADER + """MSG: radar_msgs/RadarTrack
uint16 NO_CLASSIFICATION=0
uint16 STATIC=1
uint16 DYNAMIC=2
unique_identifier_msgs/UUID uuid
geometry_msgs/Point position
geometry_msgs/Vector3 velocity
geometry_msgs/Vector3 acceleration
geometry_msgs/Vector3 size
uint16 classification
float32[6] position_covariance
float32[6] velocity_covariance
float32[6] acceleration_covariance
float32[6] size_covariance
================================================================================
MSG: unique_identifier_msgs/UUID
uint8[16] uuid
================================================================================
MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
"""
STATUS = {"": 0, "tentative": 32001, "confirmed": 32002, "coasting": 32003}  # 32000: free for all
OWN_IDS = b"rhotrack\0\0\0\0"  # before the track_id in a UUID
AXES = ("x", "y", "z")
TRAIL = 50  # points behind a track in the scene
FOUND = np.dtype([("t_s", "f8"), *((name, TRACK[name]) for name in (
    "track_id", "status", "x_m", "y_m", "z_m", "vx_mps", "vy_mps", "vz_mps", "ax_mps2", "ay_mps2",
    "az_mps2", "sigma_m", "sigma_mps"))])


class _Cdr:
    """A message as ROS 2 writes it: little endian, each number at a multiple of its size."""

    def __init__(self, time_ns: int, frame: str) -> None:
        self.data = bytearray()
        self.put("i", time_ns // 10**9)
        self.put("I", time_ns % 10**9)
        self.put("I", len(frame) + 1)
        self.data += frame.encode() + b"\0"

    def put(self, kind: str, *values: float) -> None:
        self.data += bytes(-len(self.data) % struct.calcsize(kind))
        self.data += struct.pack(f"<{len(values)}{kind}", *values)

    def message(self) -> bytes:
        return b"\0\1\0\0" + bytes(self.data)


class _File:
    """The writer, with a channel for each topic."""

    def __init__(self, stream: Any) -> None:
        from mcap.writer import Writer
        self.writer, self.channels = Writer(stream), {}
        self.writer.start(profile="ros2", library="rhotrack")

    def put(self, topic: str, kind: Any, time_ns: int, data: Any) -> None:
        """kind: name and text of a ROS message, or a class of protobuf."""
        if topic not in self.channels:
            self.channels[topic] = self._channel(topic, kind)
        self.writer.add_message(self.channels[topic], time_ns, data, time_ns)

    def _channel(self, topic: str, kind: Any) -> int:
        from mcap_protobuf.schema import register_schema
        if isinstance(kind, tuple):
            schema = self.writer.register_schema(kind[0], "ros2msg", kind[1].encode())
            return self.writer.register_channel(topic, "cdr", schema)
        return self.writer.register_channel(topic, "protobuf", register_schema(self.writer, kind))


def write(path: str | os.PathLike, scans: list[Any], tracks: np.ndarray | None) -> None:
    """Scans of plots (as Scans takes them) and tracks."""
    found = [one for data in scans for one in (
        data if isinstance(data, (list, tuple, Scans)) else Scans(data))]
    steps = [] if tracks is None else np.split(
        tracks, np.flatnonzero(np.diff(tracks["t_s"])) + 1)
    with open(path, "wb") as stream:
        file, scene = _File(stream), _Scene([*found, *steps])
        for rows in sorted([*found, *steps], key=lambda one: one["t_s"][0]):
            if "track_id" in rows.dtype.names:
                _put_tracks(file, scene, rows)
            else:
                _put_scan(file, scene, rows)
        file.writer.finish()


def _time_ns(rows: np.ndarray) -> int:
    time_s = rows["t_s"][0]
    if not 0 <= time_s < 2**31:
        raise Error(f"t_s {time_s}: times of MCAP are 0 .. 2^31 s")
    return round(time_s * 1e6) * 1000


def _put_scan(file: _File, scene: _Scene, rows: np.ndarray) -> None:
    if "bearing_rad" in rows.dtype.names:
        raise Error("bearing_rad: radar_msgs has plots, no bearings")
    sensor_id, time_ns = rows["sensor_id"][0], _time_ns(rows)
    place = [float(np.nan_to_num(field(rows, f"sensor_{axis}_m"))[0]) for axis in AXES]
    range_m, azimuth, elevation = polar_of(rows)
    is_plot = ~np.isnan(range_m)
    message = _Cdr(time_ns, f"radar_{sensor_id}")
    message.put("I", int(is_plot.sum()))
    message.put("f", *np.column_stack([
        range_m, azimuth, np.nan_to_num(elevation), field(rows, "range_rate_mps"),
        field(rows, "snr_db")])[is_plot].ravel().tolist())
    file.put(f"/radar_{sensor_id}/scan", ("radar_msgs/msg/RadarScan", SCAN), time_ns,
             message.message())
    scene.put_sensor(file, time_ns, sensor_id, place)
    up = np.nan_to_num(elevation)
    scene.put_plots(file, time_ns, sensor_id, np.column_stack([
        range_m * np.cos(up) * np.cos(azimuth), range_m * np.cos(up) * np.sin(azimuth),
        range_m * np.sin(up)])[is_plot])


def _put_tracks(file: _File, scene: _Scene, rows: np.ndarray) -> None:
    time_ns = _time_ns(rows)
    message = _Cdr(time_ns, "map")
    message.put("I", len(rows))
    for row in rows:
        names = row.dtype.names
        message.put("B", *OWN_IDS, *int(row["track_id"]).to_bytes(4, "big"))
        for unit in ("{}_m", "v{}_mps", "a{}_mps2"):
            message.put("d", *(float(row[unit.format(axis)]) for axis in AXES))
        message.put("d", 0.0, 0.0, 0.0)
        message.put("H", STATUS.get(str(row["status"]), 0) if "status" in names else 0)
        for sigma, prefix in (("sigma_m", ""), ("sigma_mps", "v")):
            message.put("f", *_triangle(row, names, sigma, prefix))
        message.put("f", *[0.0] * 12)
    file.put("/tracks", ("radar_msgs/msg/RadarTracks", TRACKS), time_ns, message.message())
    scene.put_tracks(file, time_ns, rows)


def _triangle(row: Any, names: Any, sigma: str, prefix: str) -> list[float]:
    """The upper triangle: as it is stated, or the mean variance of the measured axes."""
    if "cov_x_x" in names:
        return [float(row[f"cov_{prefix}{b}_{prefix}{a}"]) for i, a in enumerate(AXES)
                for b in AXES[i:]]
    variance = float(row[sigma])**2 if sigma in names else 0.0
    return [variance, 0.0, 0.0, variance, 0.0, variance if row["z_m"] != 0 else 0.0]


class _Scene:
    """Entities of foxglove.SceneUpdate, sized by the extent of all data."""

    def __init__(self, arrays: list[np.ndarray]) -> None:
        far = [float(np.nanmax(np.abs(rows[name]))) for rows in arrays
               for name in ("x_m", "y_m", "range_m")
               if name in rows.dtype.names and not np.isnan(rows[name]).all()]
        self.size_m = max(far, default=100.0) / 150
        self.places: dict[int, list[float]] = {}
        self.trails: dict[int, list[tuple[float, float, float]]] = {}

    def put_sensor(self, file: _File, time_ns: int, sensor_id: int, place: list[float]) -> None:
        from foxglove_schemas_protobuf.FrameTransform_pb2 import FrameTransform
        if self.places.get(sensor_id) == place:
            return
        self.places[sensor_id] = place
        transform = FrameTransform(parent_frame_id="map", child_frame_id=f"radar_{sensor_id}")
        transform.timestamp.FromNanoseconds(time_ns)
        transform.translation.x, transform.translation.y, transform.translation.z = place
        transform.rotation.w = 1.0
        file.put("/tf", FrameTransform, time_ns, transform.SerializeToString())

    def put_plots(self, file: _File, time_ns: int, sensor_id: int, places: np.ndarray) -> None:
        self._put(file, time_ns, "/scene", f"plots of {sensor_id}", f"radar_{sensor_id}",
                  places.tolist(), (0.6, 0.6, 0.6, 0.8), self.size_m / 2)

    def put_tracks(self, file: _File, time_ns: int, rows: np.ndarray) -> None:
        shown = rows[rows["status"] != "tentative"] if "status" in rows.dtype.names else rows
        for row in shown:
            trail = self.trails.setdefault(int(row["track_id"]), [])
            trail.append(tuple(float(row[f"{axis}_m"]) for axis in AXES))
            del trail[:-TRAIL]
            self._put(file, time_ns, "/scene", f"track {row['track_id']}", "map", trail[-1:],
                      (0.1, 0.5, 0.9, 1.0), self.size_m, trail)
        for gone in self.trails.keys() - set(shown["track_id"].tolist()):
            del self.trails[gone]
            self._delete(file, time_ns, f"track {gone}")

    def _put(self, file: _File, time_ns: int, topic: str, name: str, frame: str, places: list,
             color: tuple, size_m: float, trail: list | None = None) -> None:
        from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate
        update = SceneUpdate()
        entity = update.entities.add(id=name, frame_id=frame)
        entity.timestamp.FromNanoseconds(time_ns)
        for place in places:
            sphere = entity.spheres.add()
            _set(sphere.pose.position, place)
            sphere.pose.orientation.w = 1.0
            sphere.size.x = sphere.size.y = sphere.size.z = size_m
            sphere.color.r, sphere.color.g, sphere.color.b, sphere.color.a = color
        if trail:
            line = entity.lines.add(thickness=2.0, scale_invariant=True)  # type 0: a strip
            line.pose.orientation.w = 1.0
            line.color.CopyFrom(entity.spheres[0].color)
            for place in trail:
                _set(line.points.add(), place)
            text = entity.texts.add(text=name, billboard=True, font_size=14.0, scale_invariant=True)
            _set(text.pose.position, trail[-1])
            text.color.CopyFrom(entity.spheres[0].color)
        file.put(topic, SceneUpdate, time_ns, update.SerializeToString())

    def _delete(self, file: _File, time_ns: int, name: str) -> None:
        from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate
        update = SceneUpdate()
        update.deletions.add(id=name).timestamp.FromNanoseconds(time_ns)
        file.put("/scene", SceneUpdate, time_ns, update.SerializeToString())


def _set(vector: Any, place: Any) -> None:
    vector.x, vector.y, vector.z = place


# ---- Reading ----

def read(path: str | os.PathLike, kind: str | None) -> Any:
    """A list of scans, or the structured array of tracks; scans where both are there and kind is
    not said. A frame that ends with a number is that sensor's; others are numbered from 1."""
    scans: list[np.ndarray] = []
    tracks: list[tuple] = []
    sensors: dict[str, int] = {}
    uuids: dict[bytes, int] = {}
    places: dict[str, tuple] = {}
    for name, message in _messages(path):
        if name == "FrameTransform":
            place = message.translation
            places[message.child_frame_id] = (place.x, place.y, place.z)
            continue
        time_s = message.header.stamp.sec + message.header.stamp.nanosec / 1e9
        if name == "RadarScan":
            frame = message.header.frame_id
            number = re.search(r"\d+$", frame)
            sensor = sensors.setdefault(frame, int(number[0]) if number else len(sensors) + 1)
            scans.append(_scan_of(time_s, sensor, places.get(frame, (0.0, 0.0, 0.0)),
                                  message.returns))
        else:
            tracks += [_track_of(time_s, one, uuids) for one in message.tracks]
    if kind == "tracks" or (kind is None and not scans):
        return np.array(tracks, FOUND)
    if kind in (None, "scans"):
        return scans
    raise Error(f"{os.fspath(path)}: MCAP holds no {kind}")


def _messages(path: str | os.PathLike) -> Iterator[tuple[str, Any]]:
    from mcap.reader import make_reader
    from mcap_protobuf.decoder import DecoderFactory as Protobuf
    from mcap_ros2.decoder import DecoderFactory as Ros
    decoders, known = {"cdr": Ros(), "protobuf": Protobuf()}, {}
    with open(path, "rb") as stream:
        # a sensor's place has the time of its first scan, and comes first
        for schema, channel, message in sorted(
                make_reader(stream).iter_messages(), key=lambda one: (
                    one[2].log_time, one[0].name != "foxglove.FrameTransform")):
            name = schema.name.split("/")[-1].split(".")[-1]
            if name in ("RadarScan", "RadarTracks", "FrameTransform"):
                if channel.id not in known:
                    known[channel.id] = decoders[channel.message_encoding].decoder_for(
                        channel.message_encoding, schema)
                yield name, known[channel.id](message.data)


def _scan_of(time_s: float, sensor: int, place: tuple, returns: list[Any]) -> np.ndarray:
    names = ["range_m", "azimuth_rad", "elevation_rad", "range_rate_mps", "snr_db"]
    values = np.array([(one.range, one.azimuth, one.elevation, one.doppler_velocity, one.amplitude)
                       for one in returns], "f4").reshape(-1, 5)
    if not values[:, 2].any():
        values[:, 2] = np.nan  # a radar without heights
    kept = [i for i in range(5) if i < 2 or not np.isnan(values[:, i]).any() and len(values)]
    fields = [("t_s", "f8"), ("sensor_id", "i4"), *((f"sensor_{axis}_m", "f4") for axis in AXES),
              *((names[i], "f4") for i in kept)]
    rows = np.zeros(max(1, len(values)), fields)
    rows["t_s"], rows["sensor_id"] = time_s, sensor
    for axis, at in zip(AXES, place):
        rows[f"sensor_{axis}_m"] = at
    for i in kept:
        rows[names[i]] = values[:, i] if len(values) else np.nan
    return rows


def _track_of(time_s: float, track: Any, uuids: dict[bytes, int]) -> tuple:
    uuid = bytes(track.uuid.uuid)
    number = (int.from_bytes(uuid[12:], "big") if uuid.startswith(OWN_IDS)
              else uuids.setdefault(uuid, len(uuids) + 1))
    status = {value: name for name, value in STATUS.items()}.get(track.classification, "")
    return (time_s, number, status or "confirmed",
            *(getattr(vector, axis) for vector in (track.position, track.velocity,
                                                   track.acceleration) for axis in AXES),
            *(_sigma(one) for one in (track.position_covariance, track.velocity_covariance)))


def _sigma(triangle: Any) -> float:
    variances = [triangle[i] for i in (0, 3, 5) if triangle[i] > 0]
    return float(np.sqrt(np.mean(variances))) if variances else 0.0
