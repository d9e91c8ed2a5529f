"""Which joints have a pin in a bearing, whose stiffness is that of a solid."""

from types import SimpleNamespace

from trsim.scenario.plausible import contacts, modulus


def test_pins_in_bearings():
    """With a law, a radius and a clearance below it: of others nothing is said here."""
    laws = {
        "pin": SimpleNamespace(bearing_radius=0.01),
        "pad": SimpleNamespace(bearing_radius=None),
    }
    joints = {
        "good": SimpleNamespace(contact="pin", clearance=5e-4),
        "tight": SimpleNamespace(contact="pin", clearance=0.0),
        "wide": SimpleNamespace(contact="pin", clearance=0.02),
        "flat": SimpleNamespace(contact="pad", clearance=5e-4),
        "free": SimpleNamespace(contact="nothing", clearance=5e-4),
        "ideal": SimpleNamespace(),
    }
    scenario = SimpleNamespace(joints=joints, contact_laws=laws)
    assert [*contacts(scenario)] == [("good", joints["good"], laws["pin"])]


def test_the_modulus_of_a_hertzian_pin():
    """K = 4/3 E* sqrt(R_eff), 1/E* = 2 (1 - 0.3^2)/E, 1/R_eff = 1/(R - c) - 1/R."""
    E, R, c = 207e9, 0.01, 5e-4
    K = 4 / 3 * E / (2 * (1 - 0.3**2)) * (R * (R - c) / c) ** 0.5
    assert abs(modulus(K, R, c) / E - 1) < 1e-12
