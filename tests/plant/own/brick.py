"""The example of docs/plant.md: a car that is a brick on four ideal wheels."""

from plant_emulator import truth
from plant_emulator.inverter import demanded

MASS_KG, RADIUS_M, GEAR = 1400.0, 0.318, 3.0


class Brick:
    """Never slips: what the motors give goes into the road."""

    def __init__(self, scenario):
        self.speed_mps, self.distance_m, self.accel_mps2 = scenario.start_speed_mps, 0.0, 0.0

    def advance(self, demand, time_s, duration_s):
        """Drive on from ``time_s``, demands read in the middle of the way."""
        torque_nm = sum(demanded(demand, 0.5 * duration_s))
        self.accel_mps2 = GEAR * torque_nm / RADIUS_M / MASS_KG
        self.distance_m += self.speed_mps * duration_s
        self.speed_mps += self.accel_mps2 * duration_s

    def observe(self, demand, row):
        """Tell what is true now; what stays zero the car has not."""
        omega_radps = self.speed_mps / RADIUS_M
        row[truth.DISTANCE], row[truth.BODY_SPEED] = self.distance_m, self.speed_mps
        row[truth.ACCEL] = row[truth.SPECIFIC_FORCE] = self.accel_mps2
        row[truth.WHEEL_SPEED : truth.WHEEL_SPEED + 4] = omega_radps
        row[truth.MOTOR_SPEED : truth.MOTOR_SPEED + 2] = GEAR * omega_radps
        row[truth.MOTOR_TORQUE : truth.MOTOR_TORQUE + 2] = demanded(demand, 0.0)
