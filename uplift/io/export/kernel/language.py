"""How languages write declarations, types and calls: the differences between the translations of the kernel."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Language:
    """A language of the C family.

    Parameters
    ----------
    types : mapping
        Names of the types of scalars.
    suffix : str
        Ends literals of single precision.
    function, expanded : str
        Precedes the declaration of a function, and of one that is expanded where it is called.
    functions : mapping
        Names of functions that differ from Python's.
    context : tuple of str
        Parameter and argument of every function that reads the table; empty strings for a global table.
    mutable, readonly : str
        Declarations of array parameters that a function changes, and of others.
    constant : str
        Declaration of an integer constant.
    width : int, optional
        Wavelengths of one call, where it is fixed. Sizes of arrays are then numbers, as OSL requires.
    zeros : str
        Initial value of an array of zeros; without it a loop sets every array to 0.
    lanes : str
        Precedes loops over wavelengths or colours, which are to be vectorised; empty for a language of graphics
        processors, which run many colours side by side.
    warp : str
        Definition of the warp of the phase.
    """

    types: dict[str, str]
    suffix: str = ""
    function: str = ""
    expanded: str = ""
    functions: dict[str, str] = field(default_factory=dict)
    context: tuple[str, str] = ("", "")
    mutable: str = "inout {type} {name}[{size}]"
    readonly: str = "{type} {name}[{size}]"
    constant: str = "#define {name} {value}"
    width: int | None = None
    zeros: str = ""
    lanes: str = ""
    warp: str = "{function}float {name}_warp(float wavelength)\n{{{{\n    return {expression};\n}}}}\n\n"


C_TYPES = {"Float": "float", "Int": "int", "Bool": "int"}
SHADER_TYPES = {"Float": "float", "Int": "int", "Bool": "bool"}
C_CALLS = {
    "abs": "fabsf",
    "copysign": "copysignf",
    "sqrt": "sqrtf",
    "tanh": "tanhf",
    "float": "(float)",
    "int": "(int)",
}

C = Language(
    types=C_TYPES,
    suffix="f",
    function="static inline ",
    expanded="static {NAME}_EXPANDED ",
    functions=C_CALLS,
    mutable="{type} {name}[{size}]",
    readonly="const {type} {name}[{size}]",
    zeros="{{0}}",
    lanes="{NAME}_VECTORISE",
)
CUDA = Language(
    types=C_TYPES,
    suffix="f",
    function="{NAME}_FUNCTION ",
    expanded="{NAME}_FUNCTION ",
    functions=C_CALLS,
    context=("const float *table", "table"),
    mutable="{type} {name}[{size}]",
    readonly="const {type} {name}[{size}]",
    zeros="{{0}}",
)
GLSL = Language(types=SHADER_TYPES, width=4)
HLSL = Language(types=SHADER_TYPES, width=4)
OSL = Language(
    types={"Float": "float", "Int": "int", "Bool": "int"},
    functions={"float": "(float)", "int": "(int)"},
    context=("string table", "table"),
    width=3,
    mutable="output {type} {name}[{size}]",
)
WGSL = Language(
    types={"Float": "f32", "Int": "i32", "Bool": "bool"},
    width=4,
    functions={"float": "f32", "int": "i32"},
    constant="const {name}: {type} = {value};",
    warp="fn {name}_warp(wavelength: f32) -> f32 {{{{\n    return {expression};\n}}}}\n\n",
)
