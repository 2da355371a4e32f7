"""Takes bias and weight off the force and turns its axes into frame S, as flags and mapping
say, or else as the recording shows (force_frame.py)."""

import numpy as np

import flags
import force_frame
import joining
from errors import BadInput, NoSolution, UsageError


class ForceCorrection:
    """kept: what was applied, for the mapping; said: (label, text) of the summary; warnings."""

    def __init__(self, values, given, mapping):
        self.flags, self.given, self.mapping = values, given, mapping
        self.kept, self.said, self.warnings = {}, [], []
        self.axes_are_unknown = False  # the log gets the magnitude, of means where it averages

    def apply(self, recordings, columns):
        """Takes bias and weight off and turns the axes, in the table of the force."""
        axes = force_frame.force_axes(columns)
        if not axes:
            return
        force = next(r for r in recordings if axes[0] in r.channels)
        turns = bool(self.mapping.force.get("turns_with_object"))
        angle = None
        if turns:
            if axes != force_frame.SENSOR_AXES or "object_angle_deg" not in columns:
                raise BadInput(f"{self.mapping.path}: force: turns_with_object: needs "
                               "force_sensor_x_N, force_sensor_y_N and object_angle_deg")
            angle = np.deg2rad(columns["object_angle_deg"])
            self.kept["turns_with_object"] = True
        bias, weight = self._bias(recordings, columns, axes, turns)
        along = np.stack([columns[a] for a in axes], axis=1) - bias
        if axes == force_frame.SENSOR_AXES:
            along = force_frame.turned(along, angle) if turns else along
            degrees = self._rotation(columns, along - weight)
        elif axes == force_frame.JOINT_AXES:
            self._warn_of_mirror(columns, along, axes)
        values = np.stack([force.channels.pop(a) for a in axes], axis=1) - bias
        if axes != force_frame.SENSOR_AXES:
            force.channels.update(zip(axes, values.T))
            return
        if turns:
            holder = next(r for r in recordings if "object_angle_deg" in r.channels)
            at = joining.interpolate(holder.time, holder.channels["object_angle_deg"], force.time,
                                     "linear", 3 * (holder.period_s or 0), True)
            values = force_frame.turned(values, np.deg2rad(at))
        values = values - weight
        if degrees is None:  # noise would make the size of each reading too large
            force.channels.update(zip(axes, values.T))
            self.axes_are_unknown = True
        else:
            values = force_frame.turned(values, np.deg2rad(degrees))
            force.channels.update(force_x_N=values[:, 0], force_y_N=values[:, 1])

    def _free_s(self):
        text = self.flags["free_s"]
        if not text:
            return self.mapping.force.get("free_s")
        try:
            first, last = map(float, text.split(":"))
        except ValueError:
            first, last = 1.0, 0.0
        if not flags.is_span([first, last]):
            raise UsageError(f"--free_s: expected first:last, such as 0:2.5, found '{text}'")
        return [first, last]

    def _bias(self, recordings, columns, axes, turns):
        """(bias of each axis, weight): stated, estimated, or 0."""
        zero = np.zeros(len(axes)), np.zeros(2)
        wish = self.flags["force_bias_N"]
        stated = self.mapping.force.get("bias_N") if "force_bias_N" not in self.given else None
        if wish != "estimate":
            try:
                stated = [float(v) for v in wish.split(":")]
            except ValueError:
                raise UsageError("--force_bias_N: expected estimate or numbers, found "
                                 f"'{wish}'") from None
            stated = stated * len(axes) if stated == [0.0] else stated
        if stated is not None:
            if len(stated) != len(axes):
                raise BadInput(f"bias_N: expected {len(axes)} numbers, for {', '.join(axes)}")
            self.kept.update(bias_N=[float(v) for v in stated])
            if wish == "estimate":
                self._keep_stated("bias_std_N", "tool_weight_N", "tool_weight_std_N")
            weight = (self.kept.get("tool_weight_N") if turns else None) or [0.0, 0.0]
            return np.array(stated), np.array(weight)
        free_s = self._free_s()
        free = force_frame.free_rows(columns, force_frame.gauge_noise(recordings), free_s)
        try:
            if free_s is None and not turns and force_frame.follows_gauges(columns, axes, free):
                raise NoSolution("bias of the force sensor: no free rows are found, as the force of those "
                                 "that look free follows the gauges; state when the finger is free with "
                                 "--free_s, or --force_bias_N")
            if turns:
                bias, weight, std, weight_std = force_frame.bias_and_weight(columns, free)
                self.said.append(("tool weight", _values(weight, weight_std)))
                self.kept.update(tool_weight_N=_plain(weight),
                                 tool_weight_std_N=_plain(weight_std))
            else:
                bias, std = force_frame.bias(columns, axes, free)
                weight = np.zeros(2)
        except NoSolution as error:
            if "force_bias_N" in self.given:
                raise
            self.warnings.append(f"{error}; none is taken off")
            return zero
        known = np.ones(len(axes), dtype=bool) if turns else np.abs(bias) > 3 * std
        taken = "taken off" if known.all() else "left, as it is within 3 std of 0" \
            if not known.any() else f"{', '.join(np.array(axes)[known])} taken off"
        self.said.append(("force bias", f"{_values(bias, std)} {taken}, from {free.sum()} free "
                          "rows"))
        bias = np.where(known, bias, 0.0)
        self.kept.update(bias_N=_plain(bias), bias_std_N=_plain(std))
        return bias, weight

    def _rotation(self, columns, along):
        """Degrees, or None where only the magnitude is known."""
        wish = self.flags["force_rotation_deg"]
        if wish != "estimate":
            try:
                degrees = float(wish)
            except ValueError:
                degrees = np.inf
            if not np.isfinite(degrees):
                raise UsageError("--force_rotation_deg: expected estimate or a number, found "
                                 f"'{wish}'")
            self._warn_of_mirror(columns, along, force_frame.SENSOR_AXES)
        elif self.mapping.force.get("rotation_deg") is not None and \
                "force_rotation_deg" not in self.given:
            degrees = self.mapping.force["rotation_deg"]
            self._keep_stated("rotation_std_deg")
            self._warn_of_mirror(columns, along, force_frame.SENSOR_AXES)
        else:
            try:
                degrees, std = force_frame.rotation(columns, along)
            except NoSolution as error:
                if "force_rotation_deg" in self.given:
                    raise
                self.warnings.append(f"{error}; the log has the magnitude force_N")
                return None
            self.kept.update(rotation_std_deg=std)
            self.said.append(("force axes", f"turned by {degrees:.3f} deg into frame S, std "
                              f"{std:.3f} deg, if there is no friction"))
        self.kept.update(rotation_deg=float(degrees))
        if self.kept.get("rotation_std_deg"):
            # Fixed axes would be blamed for what their std leaves.
            self.said.append(("for the plan", "parameters: {force_tilt: {prior_std_deg: "
                              f"{self.kept['rotation_std_deg']:.2g}}}}}, as well as the axes are known"))
        return degrees

    def _warn_of_mirror(self, columns, along, axes):
        wrong = force_frame.mirrored(columns, along, axes)
        if wrong:
            self.warnings.append(f"axes of the force: {wrong}")

    def _keep_stated(self, *keys):
        self.kept.update((key, self.mapping.force[key]) for key in keys
                         if self.mapping.force.get(key) is not None)


def _plain(values):
    return [float(v) for v in values]


def _values(values, std):
    return ", ".join(f"{v:.4g} N (std {s:.2g})" for v, s in zip(values, std))
