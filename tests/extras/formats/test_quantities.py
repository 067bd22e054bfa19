"""The table of quantities: what labels, lines of text, names and values state, and what
they do not.
"""

import numpy as np
import pytest

from uplift.extras.formats.quantities import (
    QUANTITIES,
    label_quantity,
    name_quantities,
    remark_quantity,
    value_quantity,
)


def kind(quantity):
    return None if quantity is None else quantity.kind.name


@pytest.mark.parametrize(
    ("texts", "expected"),
    [
        ("Reflectance|%R|Réflectance (%)|Reflexionsgrad [%]|BRF reflectance", "reflec"),
        ("%T|T (%)|T400|T-factor|Transmission", "transmittance"),
        ("Abs 400|Absorbance|log(1/R)|-log10(R)|LOG10(1/R)", "absorbance"),
        ("Density|ochre density|Density400|OD 400", "optical density"),
        ("K/S|k / s|ochre K/S|KS|KS400|K_S|F(R)|KUBELKA-MUNK", "K/S"),
        ("absorption|mu_a|µs'|Scattering coefficient (1/mm)", "absorption or"),
        ("refractive index|index of refraction|permittivity", "refractive index"),
        ("x_bar|x-bar|xbar10|ȳ (λ) zbar|CIE_xyz_1931_2deg|CMF|V(λ)", "sensitivity"),
        ("Std. Dev.|stdev|Standard deviation|Reflectance std|R uncertainty|σ", "stand"),
        ("Rad. (Ref.)|SPD|Irradiance|µW/cm²/nm|W·m-2·nm-1|mW m^-2 nm^-1", "spectral"),
        ("power (W)|CIE_std_illum_A_1nm|Illuminant D50|relative power", "spectral"),
        ("Photon flux density (µmol m-2 s-1 nm-1)|PPFD|quanta", "photon flux"),
        ("[counts]|raw|Raw counts|DN|digital numbers", "counts"),
        ("Illuminance|cd/m²|Luminance", "measurement of a light"),
        (
            "ochre|Std|T1|T12 blue|STD Blue|a|R|K|S|n|Low density polyethylene|DN5"
            "|powder blue|Samples|Radiant Turquoise|F (Red)|Raw umber",
            "None",
        ),
    ],
)  # fmt: skip
def test_labels(texts, expected):
    found = [(text, str(kind(label_quantity(text)))) for text in texts.split("|")]
    assert [pair for pair in found if not pair[1].startswith(expected)] == []


def test_examples_of_the_table_are_found():
    for row in QUANTITIES.values():
        texts = [text.split("; ")[-1] for text in row.examples.split(", ")]
        known = set()
        for text in texts:
            _, named = name_quantities(["ochre", text])
            known.add(kind(label_quantity(text) or remark_quantity([text]) or named))
        assert row.name == "another quantity" or row.name in known, row.name


LIGHT_METERS = (
    "LUX 250.5", "CCT: 3050", "CCT(K)=3050", "fc 23.3", "Duv 0.001", "CRI(Ra) 92",
    "Tcp [K] 3000", "PPFD: 3 µmol/m²/s", "PFD-UV 0.1",
    "LUX 250,5", "Illuminance [lx] 300", "Color temperature 3000 K",
)  # fmt: skip


def test_keys_of_light_meters():
    for text in LIGHT_METERS:
        assert kind(remark_quantity([text])) == "measurement of a light", text
        assert kind(remark_quantity([text, "Mode: reflectance"])) == "reflectance", text


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("K/S = (1 - R)² / 2R of the reflectance", "K/S"),
        ("Reflection density, status T", "optical density"),
        ("Reflectance and transmittance accessory", "reflectance"),
        ('DEVICE_CLASS "DISPLAY"', "spectral power"),
    ],
)
def test_remarks(text, expected):
    assert kind(remark_quantity([text])) == expected


def test_remarks_about_the_instrument_state_no_quantity():
    others = ["Illuminant: D65", "Lamp: xenon", "Scan counts: 3", "power: 9 V"]
    others += ["Integration time: 500 µs", "Detector: photon counting", "5 mmol/mL"]
    others += ["Color matching functions: CIE 1931", "Fluorescence: none", "x 0.43"]
    others += ["Uncertainty: 0.5 %", "Density: 1.2 g/cm3", "Observer: 2 deg"]
    assert remark_quantity(others) is None


@pytest.mark.parametrize(
    ("names", "expected"),
    [
        ("K S", "aa"), ("S k", "  "), ("K_ochre S_ochre K_red S_red", "aaaa"),
        ("ochre_k ochre_s umber", "aa "), ("R K S", " aa"), ("C M Y K", "    "),
        ("A1 K1 S1", "   "), ("R_K R_S", "  "), ("R T", " s"), ("D", "b"),
        ("D red", "  "), ("n k", "rr"), ("N K", "  "), ("X Y Z", "sss"),
        ("x y", "  "), ("X Y Z W", "    "), ("A D65", "pp"), ("A B C", "   "),
        ("D50 D51", "  "), ("FL2 LED-B3", "pp"), ("W", "p"), ("W R G B", "    "),
        ("mean SD", " d"), ("ochre ochre_std umber", " d "), ("ochre SD_ochre", " d"),
        ("STD_red STD_blue", "  "), ("std", " "), ("ochre1 std1", "  "),
        ("R1 std1", " d"), ("ochre_K/S umber", "k "), ("Absorbance OD", "bb"),
    ],
)  # fmt: skip
def test_names_state_a_quantity_as_a_set(names, expected):
    letters = {"absorption or scattering": "a", "refractive index": "r"}
    letters |= {"standard deviation": "d", "spectral power": "p", None: " "}
    letters |= {"K/S": "k", "absorbance": "b", "optical density": "b"}
    found = map(kind, name_quantities(names.split(" ")))
    assert "".join(letters.get(name, "s") for name in found) == expected


def test_values_of_illuminants():
    nm = np.arange(380, 781, 10)
    assert kind(value_quantity(nm, 100 + (560 - nm) / 20)) == "spectral power"
    for values in (np.full(41, 100.0), nm / 5.6, nm * 0.0, 99 + (560 - nm) / 20):
        assert value_quantity(nm, np.minimum(values, 100)) is None
