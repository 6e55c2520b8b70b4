# SPDX-License-Identifier: GPL-3.0-or-later
# Written by python/tools/write_stub.py; not to be changed by hand.
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, Literal

from numpy import ndarray
from numpy.typing import ArrayLike

PathLike = str | os.PathLike[str]
__version__: str


class Findings(dict[str, Any]):
    def __getattr__(self, name: str) -> Any: ...


class Error(Exception):
    subject: str
    reason: str
    remedy: str
    field: str | None


class UsageError(Error, ValueError): ...
class InvalidInput(Error, ValueError): ...
class FileError(Error, OSError): ...
class Unsupported(Error, RuntimeError): ...
class Doubt(UserWarning): ...


class Interrupted(KeyboardInterrupt):
    partial: Any


def parameters(function: str | Callable[..., Any]) -> Findings: ...


class HeightField:
    def __init__(self, heights: ArrayLike, pitch: float | str | Sequence[float | str] = 1, origin: tuple[float, float] = (0, 0), valid: ArrayLike | None = None, record: Mapping[str, str] | None = None) -> None: ...
    @property
    def heights(self) -> ndarray: ...
    @property
    def valid(self) -> ndarray: ...
    @property
    def shape(self) -> tuple[int, int]: ...
    @property
    def pitch(self) -> tuple[float, float]: ...
    @property
    def origin(self) -> tuple[float, float]: ...
    @property
    def extent(self) -> tuple[float, float, float, float]: ...
    def __array__(self, dtype: Any = None) -> ndarray: ...
    @property
    def record(self) -> dict[str, str]: ...
    @record.setter
    def record(self, value: dict[str, str]) -> None: ...
    @property
    def found(self) -> Findings: ...
    def _repr_html_(self) -> str: ...
    def plot(self, *args: Any, **keywords: Any) -> Any: ...


class Tip:
    def __init__(self, heights: ArrayLike, pitch: float | str | Sequence[float | str] = 1, record: Mapping[str, str] | None = None) -> None: ...
    @property
    def heights(self) -> ndarray: ...
    @property
    def shape(self) -> tuple[int, int]: ...
    @property
    def pitch(self) -> tuple[float, float]: ...
    @property
    def apex(self) -> tuple[int, int]: ...
    @property
    def doubt(self) -> str: ...
    def __array__(self, dtype: Any = None) -> ndarray: ...
    @property
    def record(self) -> dict[str, str]: ...
    @record.setter
    def record(self, value: dict[str, str]) -> None: ...
    @property
    def found(self) -> Findings: ...
    def _repr_html_(self) -> str: ...
    def plot(self, *args: Any, **keywords: Any) -> Any: ...


class Image:
    def __init__(self, channels: dict[str, Any], pitch: float | str | Sequence[float | str] = 1, origin: tuple[float, float] = (0, 0), units: Mapping[str, str] | None = None, record: Mapping[str, str] | None = None) -> None: ...
    def __getitem__(self, channel: str) -> ndarray: ...
    def __contains__(self, channel: object) -> bool: ...
    def __len__(self) -> int: ...
    def __iter__(self) -> Iterator[str]: ...
    def keys(self) -> list[str]: ...
    def stderr(self, channel: str) -> ndarray: ...
    @property
    def channels(self) -> list[str]: ...
    @property
    def units(self) -> dict[str, str]: ...
    @property
    def shape(self) -> tuple[int, int]: ...
    @property
    def pitch(self) -> tuple[float, float]: ...
    @property
    def origin(self) -> tuple[float, float]: ...
    @property
    def extent(self) -> tuple[float, float, float, float]: ...
    @property
    def record(self) -> dict[str, str]: ...
    @record.setter
    def record(self, value: dict[str, str]) -> None: ...
    @property
    def found(self) -> Findings: ...
    def _repr_html_(self) -> str: ...
    def plot(self, *args: Any, **keywords: Any) -> Any: ...


class Mesh:
    def __init__(self, vertices: ArrayLike, triangles: ArrayLike, name: str = '', material: str = '', record: Mapping[str, str] | None = None) -> None: ...
    @property
    def vertices(self) -> ndarray: ...
    @property
    def triangles(self) -> ndarray: ...
    @property
    def bounds(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]: ...
    @property
    def name(self) -> str: ...
    @name.setter
    def name(self, value: str) -> None: ...
    @property
    def material(self) -> str: ...
    @material.setter
    def material(self, value: str) -> None: ...
    @property
    def record(self) -> dict[str, str]: ...
    @record.setter
    def record(self, value: dict[str, str]) -> None: ...
    @property
    def found(self) -> Findings: ...
    def _repr_html_(self) -> str: ...
    def plot(self, *args: Any, **keywords: Any) -> Any: ...


def read_heights(
    path: PathLike,
    *,
    height_channel: str | None = None,
    height_unit: float | str | None = None,
    height_pitch: float | str | None = None,
) -> HeightField:
    """Read an AFM scan of any format, or an image of heights."""


def write_heights(
    path: PathLike,
    heights: HeightField | ArrayLike,
    *,
    record: Mapping[str, str] | None = None,
    height_unit: float | str | None = None,
    height_pitch: float | str | None = None,
) -> None:
    """Write heights to a file."""


def read_tip(
    path: PathLike,
) -> Tip:
    """Read a tip: a file of semsurf, or any file of heights."""


def write_tip(
    path: PathLike,
    tip: Tip,
    *,
    record: Mapping[str, str] | None = None,
) -> None:
    """Write a tip to a file."""


def read_image(
    path: PathLike,
) -> Image:
    """Read an image with all its channels: EXR, TIFF, PNG, VTI."""


def write_image(
    path: PathLike,
    image: Image | ArrayLike,
    *,
    channel: str | None = None,
    record: Mapping[str, str] | None = None,
) -> None:
    """Write an image to a file."""


def read_sem_image(
    path: PathLike,
    *,
    sem_channel: str | None = None,
    pixel_size: float | str | None = None,
) -> Image:
    """Read a microscope's image, with its pixel size, without its strip of text."""


def read_mesh(
    path: PathLike,
    *,
    unit: str | None = None,
    override_unit: bool = False,
) -> Mesh:
    """Read a mesh: STL, OBJ, PLY, OFF, glTF, 3MF, VTP, VTM."""


def info(
    path: PathLike,
    *,
    unit: str | None = None,
    override_unit: bool = False,
    material: str | None = None,
    materials: PathLike | Sequence[PathLike] | None = None,
) -> Findings:
    """What is in a mesh, an image, a scan, a model or a scene file."""


def simulate(
    specimen: PathLike | Mesh | HeightField | ArrayLike | Sequence,
    *,
    dry_run: bool | None = None,
    acceptance: dict[str, Any] | None = None,
    progress: bool | Callable[[float, float, str], object] | None = None,
    material: str | None = None,
    materials: PathLike | Sequence[PathLike] | None = None,
    unit: str | None = None,
    override_unit: bool = False,
    substrate: str | None = None,
    substrate_z: float | str | None = None,
    edge: Literal['mirror', 'flat', 'periodic'] | None = None,
    height_channel: str | None = None,
    height_unit: float | str | None = None,
    height_pitch: float | str | None = None,
    energy: float | str = '1keV',
    tilt: float | str = '0deg',
    azimuth: float | str = '0deg',
    spot: float | str = '0nm',
    convergence: float | str = '0deg',
    focus: float | str = '0nm',
    working_distance: float | str = '0nm',
    size: str | float | Sequence | None = None,
    pixel_size: float | str | None = None,
    region: str | float | Sequence | None = None,
    electrons: int | None = None,
    accuracy: float | str | None = None,
    accuracy_floor: float | None = None,
    time: float | str | None = None,
    current: float | str | None = None,
    dwell: float | str | None = None,
    method: Literal['auto', 'direct', 'replay'] | None = None,
    mesh_tolerance: float | str = '0nm',
    detector: str | float | Sequence | None = None,
    physics: str | Mapping[str, str] | None = None,
    cutoff: float | str = '0eV',
    seed: int = 1,
    estimate: Literal['plain', 'guided', 'auto'] | None = None,
    guide_model: PathLike | None = None,
    threads: int | None = None,
    cache: PathLike | None = None,
    channels: str | float | Sequence | None = None,
    deposit: int | None = None,
    trajectories: int | None = None,
    trajectories_at: str | float | Sequence | None = None,
    spectra: bool = False,
    png_channel: str | None = None,
    layout: Literal['auto', 'rows', 'tiles'] | None = None,
    output: PathLike | Sequence[PathLike] | None = None,
    checkpoint: PathLike | None = None,
    checkpoint_every: float | str = '30s',
    restart: bool = False,
) -> Image:
    """Simulate the SEM image of a specimen by Monte Carlo."""


def level(
    scan: PathLike | HeightField | ArrayLike,
    *,
    use: PathLike | Image | ArrayLike | None = None,
    exclude: PathLike | Image | ArrayLike | None = None,
    progress: bool | Callable[[float, float, str], object] | None = None,
    level_method: Literal['hough', 'plane', 'polynomial', 'none'] = 'hough',
    level_degree: int = 2,
    level_tolerance: float | str | None = None,
    rows: Literal['none', 'median', 'difference'] | None = None,
    height_channel: str | None = None,
    height_unit: float | str | None = None,
    height_pitch: float | str | None = None,
    threads: int | None = None,
) -> HeightField:
    """Level an AFM scan: take its background off."""


def clean(
    scan: PathLike | HeightField | ArrayLike,
    *,
    progress: bool | Callable[[float, float, str], object] | None = None,
    spikes: str | None = None,
    median: int | None = None,
    closing: int | None = None,
    disc: bool = False,
    fill_holes: bool = False,
    height_channel: str | None = None,
    height_unit: float | str | None = None,
    height_pitch: float | str | None = None,
    threads: int | None = None,
) -> HeightField:
    """Take spikes, noise and pits out of an AFM scan."""


def erode(
    scan: PathLike | HeightField | ArrayLike,
    tip: PathLike | Tip | HeightField,
    *,
    progress: bool | Callable[[float, float, str], object] | None = None,
    height_channel: str | None = None,
    height_unit: float | str | None = None,
    height_pitch: float | str | None = None,
    upsample: int = 1,
    distance: float | str = '0nm',
    threads: int | None = None,
) -> HeightField:
    """Take a tip out of a scan: the highest surface that agrees with it."""


def dilate(
    scan: PathLike | HeightField | ArrayLike,
    tip: PathLike | Tip | HeightField,
    *,
    progress: bool | Callable[[float, float, str], object] | None = None,
    height_channel: str | None = None,
    height_unit: float | str | None = None,
    height_pitch: float | str | None = None,
    upsample: int = 1,
    distance: float | str = '0nm',
    threads: int | None = None,
) -> HeightField:
    """The scan that a tip makes of a surface."""


def open(
    scan: PathLike | HeightField | ArrayLike,
    tip: PathLike | Tip | HeightField,
    *,
    progress: bool | Callable[[float, float, str], object] | None = None,
    height_channel: str | None = None,
    height_unit: float | str | None = None,
    height_pitch: float | str | None = None,
    upsample: int = 1,
    threads: int | None = None,
) -> HeightField:
    """Take off a scan what a tip cannot have touched: erosion, then dilation."""


def close(
    scan: PathLike | HeightField | ArrayLike,
    tip: PathLike | Tip | HeightField,
    *,
    progress: bool | Callable[[float, float, str], object] | None = None,
    height_channel: str | None = None,
    height_unit: float | str | None = None,
    height_pitch: float | str | None = None,
    upsample: int = 1,
    threads: int | None = None,
) -> HeightField:
    """Fill what a tip does not reach of a surface: dilation, then erosion."""


def certainty(
    scan: PathLike | HeightField | ArrayLike,
    tip: PathLike | Tip | HeightField,
    *,
    progress: bool | Callable[[float, float, str], object] | None = None,
    height_channel: str | None = None,
    height_unit: float | str | None = None,
    height_pitch: float | str | None = None,
    height_noise: float | str | None = None,
    sigmas: float = 3,
    neighbourhood: int | None = None,
    distance: float | str = '0nm',
    threads: int | None = None,
) -> Image:
    """Where an eroded scan is the surface."""


def tip(
    scan: PathLike | HeightField | ArrayLike | Sequence | None = None,
    *,
    characterizer: PathLike | HeightField | ArrayLike | None = None,
    progress: bool | Callable[[float, float, str], object] | None = None,
    tip_size: int = 21,
    answer: Literal['sweep', 'outer', 'best', 'blind'] | None = None,
    height_noise: str | float | Sequence | None = None,
    threshold: float | str | None = None,
    threshold_y: float | str | None = None,
    apex_tolerance: float | str = '0nm',
    layer: float | str = '0nm',
    maxima: bool = False,
    sweep: str | float | Sequence | None = None,
    seed: int = 1,
    shape: str | None = None,
    search: int = 10,
    height_channel: str | None = None,
    height_unit: float | str | None = None,
    height_pitch: float | str | None = None,
    threads: int | None = None,
) -> Tip:
    """Find the tip that made a scan, or make one by its shape."""


def noise(
    scan: PathLike | HeightField | ArrayLike,
    *,
    use: PathLike | Image | ArrayLike | None = None,
    exclude: PathLike | Image | ArrayLike | None = None,
    progress: bool | Callable[[float, float, str], object] | None = None,
    flat: bool = False,
    degree: int = 2,
    lags: int = 10,
    height_channel: str | None = None,
    height_unit: float | str | None = None,
    height_pitch: float | str | None = None,
    threads: int | None = None,
) -> Findings:
    """The noise of an AFM scan, and whether the model fits."""


def noise_sem(
    image: PathLike | Image | ArrayLike,
    *,
    block: int | None = None,
    black: float | None = None,
    white: float | None = None,
    sem_channel: str | None = None,
    pixel_size: float | str | None = None,
) -> Findings:
    """The noise of an SEM image: the line variance = slope mean + intercept."""


def noise_counts(
    scene: PathLike,
    *,
    progress: bool | Callable[[float, float, str], object] | None = None,
    at: str | float | Sequence | None = None,
    electrons: str | float | Sequence = '1,20,100',
    trials: int = 10000,
    seed: int | None = None,
    threads: int | None = None,
) -> Findings:
    """Count the electrons from a stationary beam, many times over."""


def check_mesh(
    mesh: PathLike | Mesh,
    *,
    progress: bool | Callable[[float, float, str], object] | None = None,
    unit: str | None = None,
    override_unit: bool = False,
    threads: int | None = None,
) -> Findings:
    """What is wrong with a mesh: holes, edges, orientation."""


def repair_mesh(
    mesh: PathLike | Mesh,
    *,
    progress: bool | Callable[[float, float, str], object] | None = None,
    stitch: float | str | None = None,
    sliver: float | str = '0nm',
    max_hole: float | str | None = None,
    min_component: float | str = '0nm',
    keep_intersections: bool = False,
    unit: str | None = None,
    override_unit: bool = False,
    threads: int | None = None,
) -> Mesh:
    """Repair a mesh: merge, stitch, orient, fill holes, resolve self-intersections."""


def simplify(
    mesh: PathLike | Mesh,
    *,
    progress: bool | Callable[[float, float, str], object] | None = None,
    mesh_tolerance: float | str | None = None,
    triangles: int | None = None,
    unit: str | None = None,
    override_unit: bool = False,
    threads: int | None = None,
) -> Mesh:
    """Simplify a mesh: fewer triangles, nowhere farther off than is proven."""


def smooth(
    mesh: PathLike | Mesh,
    *,
    iterations: int | None = None,
    progress: bool | Callable[[float, float, str], object] | None = None,
    unit: str | None = None,
    override_unit: bool = False,
    threads: int | None = None,
) -> Mesh:
    """Smooth a mesh without shrinking it (Taubin)."""


def solid(
    mesh: PathLike | Mesh,
    *,
    thickness: float | str | None = None,
    progress: bool | Callable[[float, float, str], object] | None = None,
    unit: str | None = None,
    override_unit: bool = False,
    threads: int | None = None,
) -> Mesh:
    """Give an open sheet, as `mesh_heights` makes it, walls and a base."""


def mesh_heights(
    heights: PathLike | HeightField | ArrayLike,
    *,
    progress: bool | Callable[[float, float, str], object] | None = None,
    mesh_tolerance: float | str | None = None,
    triangles: int | None = None,
    height_channel: str | None = None,
    height_unit: float | str | None = None,
    height_pitch: float | str | None = None,
    threads: int | None = None,
) -> Mesh:
    """The surface of heights as a mesh, thinned where that is asked for."""


def predict(
    heights: PathLike | HeightField | ArrayLike,
    *,
    progress: bool | Callable[[float, float, str], object] | None = None,
    model: PathLike | None = None,
    edge: Literal['mirror', 'flat', 'periodic'] | None = None,
    resample: bool = False,
    height_channel: str | None = None,
    height_unit: float | str | None = None,
    height_pitch: float | str | None = None,
    material: str | None = None,
    energy: float | str | None = None,
    spot: float | str | None = None,
    output: PathLike | Sequence[PathLike] | None = None,
    png_channel: str | None = None,
    threads: int | None = None,
) -> Image:
    """An SEM image of heights by a fast model, in place of a simulation."""


def estimate(
    image: PathLike | Image,
    *,
    progress: bool | Callable[[float, float, str], object] | None = None,
    guides: str | None = None,
    model: PathLike | None = None,
    output: PathLike | Sequence[PathLike] | None = None,
    png_channel: str | None = None,
    threads: int | None = None,
) -> Image:
    """A simulated image of few electrons, estimated with the help of neighbours."""


def train(
    heights: PathLike | HeightField | ArrayLike | Sequence | None = None,
    *,
    images: PathLike | Image | Sequence | None = None,
    signal: PathLike | Image | Sequence | None = None,
    progress: bool | Callable[[float, float, str], object] | None = None,
    material: str | None = None,
    materials: PathLike | Sequence[PathLike] | None = None,
    surfaces: int | None = None,
    surface_size: int = 64,
    hold_out: int = 0,
    estimate: Literal['plain', 'guided'] = 'plain',
    fine: int | None = None,
    edge: Literal['mirror', 'flat', 'periodic'] = 'mirror',
    height_channel: str | None = None,
    height_unit: float | str | None = None,
    height_pitch: float | str | None = None,
    pixel_size: float | str | None = None,
    kind: Literal['facet-network', 'filter-bank', 'slope-table', 'slope-table-two-planes', 'stopping-points', 'diffusion-matrix', 'secant', 'ikeuchi-exponential', 'ikeuchi-secant', 'ikeuchi-mixed'] = 'facet-network',
    scales: str | float | Sequence | None = None,
    hidden: str | float | Sequence | None = None,
    iterations: int | None = None,
    decay: float | None = None,
    model_error: float | str | None = None,
    least_eigenvalue: float | str | None = None,
    multi_resolution: bool = False,
    table_electrons: int | None = None,
    energy: float | str = '1keV',
    spot: float | str = '0nm',
    electrons: int | None = None,
    accuracy: float | str | None = None,
    detector: str | float | Sequence | None = None,
    physics: str | Mapping[str, str] | None = None,
    cutoff: float | str = '0eV',
    seed: int = 1,
    cache: PathLike | None = None,
    output: PathLike | None = None,
    threads: int | None = None,
) -> Findings:
    """Train a fast model of SEM images, on simulated or real ones."""


def register(
    afm: PathLike | HeightField | ArrayLike,
    sem: PathLike | Image | ArrayLike,
    *,
    tip: PathLike | Tip | str | None = None,
    landmarks: PathLike | ArrayLike | None = None,
    progress: bool | Callable[[float, float, str], object] | None = None,
    material: str | None = None,
    materials: PathLike | Sequence[PathLike] | None = None,
    height_channel: str | None = None,
    height_unit: float | str | None = None,
    height_pitch: float | str | None = None,
    level_method: Literal['hough', 'plane', 'polynomial', 'none'] = 'hough',
    level_degree: int = 2,
    level_tolerance: float | str | None = None,
    rows: Literal['none', 'median', 'difference'] | None = None,
    height_noise: str | float | Sequence | None = None,
    tip_size: int | None = None,
    sem_channel: str | None = None,
    pixel_size: float | str | None = None,
    energy: float | str | None = None,
    spot: float | str | None = None,
    physics: str | Mapping[str, str] | None = None,
    model: PathLike | None = None,
    signal: str | None = None,
    cache: PathLike | None = None,
    objective: Literal['correlation', 'mutual-information'] = 'correlation',
    landmarks_only: bool = False,
    seed: int = 1,
    output: PathLike | None = None,
    picture: PathLike | None = None,
    threads: int | None = None,
) -> Findings:
    """Lay an SEM image on an AFM scan of the same place."""


def reconstruct(
    afm: PathLike | HeightField | ArrayLike | None = None,
    sem: PathLike | Image | ArrayLike | Sequence | None = None,
    *,
    tip: PathLike | Tip | str | None = None,
    landmarks: PathLike | ArrayLike | None = None,
    calibration: PathLike | None = None,
    truth: PathLike | HeightField | ArrayLike | None = None,
    progress: bool | Callable[[float, float, str], object] | None = None,
    material: str | None = None,
    materials: PathLike | Sequence[PathLike] | None = None,
    height_channel: str | None = None,
    height_unit: float | str | None = None,
    height_pitch: float | str | None = None,
    level_method: Literal['hough', 'plane', 'polynomial', 'none'] = 'hough',
    level_degree: int = 2,
    level_tolerance: float | str | None = None,
    rows: Literal['none', 'median', 'difference'] | None = None,
    height_noise: str | float | Sequence | None = None,
    tip_size: int | None = None,
    sem_channel: str | None = None,
    pixel_size: float | str | None = None,
    energy: float | str | None = None,
    spot: float | str | None = None,
    physics: str | Mapping[str, str] | None = None,
    model: PathLike | None = None,
    signal: str | None = None,
    cache: PathLike | None = None,
    tilt: str | float | Sequence | None = None,
    azimuth: str | float | Sequence | None = None,
    view_energy: str | float | Sequence | None = None,
    view_signal: str | float | Sequence | None = None,
    tilt_error: float | str = '0.5deg',
    view_model: PathLike | Sequence[PathLike] | None = None,
    view_gains: str | float | Sequence | None = None,
    view_noise: str | float | Sequence | None = None,
    view_place: str | float | Sequence | None = None,
    gains: str | float | Sequence | None = None,
    offset: float | None = None,
    sem_noise: str | float | Sequence | None = None,
    model_error: float | str = '5%',
    line_jitter: float = 0,
    film: str | None = None,
    corrections: int = 2,
    correction_electrons: int = 32,
    objective: Literal['correlation', 'mutual-information'] = 'correlation',
    landmarks_only: bool = False,
    transform: PathLike | None = None,
    accept_registration: bool = False,
    scan_tilt: str | float | Sequence | None = None,
    optimiser: Literal['gauss-newton', 'conjugate-gradients', 'lbfgs'] = 'gauss-newton',
    scales: str | float | Sequence | None = None,
    iterations: int | None = None,
    optimiser_tolerance: float | None = None,
    prior: float | None = None,
    fixed_transform: bool = False,
    fit_drift: bool = False,
    fixed_calibration: bool = False,
    fit_spot: bool = False,
    refine_tip: bool = False,
    no_uncertainty: bool = False,
    probes: int = 6,
    seed: int = 1,
    keep_tip: bool = False,
    upsample: int = 3,
    output: PathLike | None = None,
    no_picture: bool = False,
    threads: int | None = None,
) -> Findings:
    """The surface that makes an AFM scan and an SEM image most likely."""


def profile(
    image: PathLike | Image | ArrayLike,
    *,
    sem: PathLike | Image | ArrayLike | Sequence | None = None,
    afm: PathLike | HeightField | ArrayLike | None = None,
    progress: bool | Callable[[float, float, str], object] | None = None,
    material: str | None = None,
    materials: PathLike | Sequence[PathLike] | None = None,
    sem_channel: str | None = None,
    pixel_size: float | str | None = None,
    kind: Literal['line', 'trench', 'edge', 'hole'] = 'line',
    along_x: bool = False,
    height: float | str | None = None,
    height_error: float | str = '0nm',
    pitch: float | str | None = None,
    angle: float | str = '87deg',
    angle_range: float | str = '7deg',
    top_radius: float | str = '4nm',
    foot_radius: float | str = '4nm',
    walls_apart: bool = False,
    threshold: float = 0.5,
    energy: float | str | None = None,
    spot: float | str = '0nm',
    physics: str | Mapping[str, str] | None = None,
    signal: str = 'SE',
    tilt: str | float | Sequence | None = None,
    azimuth: str | float | Sequence | None = None,
    view_energy: str | float | Sequence | None = None,
    view_signal: str | float | Sequence | None = None,
    tilt_error: float | str = '0.5deg',
    electrons: int = 500,
    middle_electrons: int = 20000,
    rounds: int = 3,
    model_error: float | str = '8%',
    seed: int = 1,
    cache: PathLike | None = None,
    threads: int | None = None,
    no_picture: bool = False,
    output: PathLike | None = None,
) -> Findings:
    """Widths, wall angles and edge roughness of lines, trenches and holes."""


def materials(
    *,
    material: str | None = None,
    materials: PathLike | Sequence[PathLike] | None = None,
) -> Findings:
    """The materials and their numbers."""


def survey(
    scans: PathLike | HeightField | ArrayLike | Sequence,
    *,
    csv: PathLike | None = None,
    progress: bool | Callable[[float, float, str], object] | None = None,
    no_tip: bool = False,
    draws: int = 5,
    level_method: Literal['hough', 'plane', 'polynomial', 'none'] = 'hough',
    level_degree: int = 2,
    level_tolerance: float | str | None = None,
    rows: Literal['none', 'median', 'difference'] | None = None,
    tip_size: int = 21,
    seed: int = 1,
    height_channel: str | None = None,
    height_unit: float | str | None = None,
    height_pitch: float | str | None = None,
    threads: int | None = None,
) -> list[Findings]:
    """Roughness, noise, tip and its broadening of many AFM scans, as a table."""


def sample(
    *,
    progress: bool | Callable[[float, float, str], object] | None = None,
    name: str | None = None,
    output: PathLike | None = None,
    electrons: int = 200,
    size: str | float | Sequence = '456x172',
    physics: str | Mapping[str, str] | None = None,
    cutoff: float | str = '0eV',
    tip_lean: float | str = '0deg',
    tip_azimuth: float | str = '0deg',
    gain_drift: float = 0,
    spot: float | str | None = None,
    detector: str | None = None,
    film: str | None = None,
    film_thickness: float | str = '2nm',
    scan_drift: float = 0,
    line_jitter: float = 0,
    seed: int = 1,
    cache: PathLike | None = None,
    threads: int | None = None,
) -> Findings:
    """A scan and an SEM image of a known surface, to try a reconstruction on."""


def libraries(
    *,
    check: bool | None = None,
    cache: PathLike | None = None,
) -> Findings:
    """The libraries of cascades in the cache."""


def build_libraries(
    material: str | Sequence[str],
    *,
    progress: bool | Callable[[float, float, str], object] | None = None,
    energy: str | float | Sequence = '1keV',
    cascades: int | None = None,
    accuracy: float | str | None = None,
    physics: str | Mapping[str, str] | None = None,
    cutoff: float | str = '0eV',
    seed: int = 1,
    cache: PathLike | None = None,
    threads: int | None = None,
    materials: PathLike | Sequence[PathLike] | None = None,
) -> list[Findings]:
    """Make libraries of cascades and keep them in the cache."""


def remove_libraries(
    material: str | Sequence[str] | None = None,
    *,
    energy: str | float | Sequence | None = None,
    all: bool = False,
    damaged: bool = False,
    dry_run: bool = False,
    cache: PathLike | None = None,
) -> Findings:
    """Remove libraries of cascades from the cache."""


def calibrate(
    image: PathLike | Image | ArrayLike,
    simulated: PathLike | Image,
    *,
    use: PathLike | Image | ArrayLike | None = None,
    exclude: PathLike | Image | ArrayLike | None = None,
    output: PathLike | None = None,
    progress: bool | Callable[[float, float, str], object] | None = None,
    edge: Literal['mirror', 'flat', 'periodic'] = 'mirror',
    fit: str | None = None,
    ratio: float | None = None,
    offset: float | None = None,
    black: float | None = None,
    white: float | None = None,
    range: float | str | None = None,
    sem_channel: str | None = None,
    pixel_size: float | str | None = None,
    threads: int | None = None,
) -> Findings:
    """Gains and offset that turn simulated images into a real one."""


def sweep(
    specimen: PathLike | Sequence[PathLike],
    *,
    vary: dict[str, str | Sequence],
    format: str | Sequence[str] | None = None,
    progress: bool | Callable[[float, float, str], object] | None = None,
    output: PathLike | None = None,
    part: str | float | Sequence | None = None,
    material: str | None = None,
    materials: PathLike | Sequence[PathLike] | None = None,
    unit: str | None = None,
    override_unit: bool = False,
    substrate: str | None = None,
    substrate_z: float | str | None = None,
    edge: Literal['mirror', 'flat', 'periodic'] | None = None,
    height_channel: str | None = None,
    height_unit: float | str | None = None,
    height_pitch: float | str | None = None,
    energy: float | str = '1keV',
    tilt: float | str = '0deg',
    azimuth: float | str = '0deg',
    spot: float | str = '0nm',
    convergence: float | str = '0deg',
    focus: float | str = '0nm',
    working_distance: float | str = '0nm',
    size: str | float | Sequence | None = None,
    pixel_size: float | str | None = None,
    region: str | float | Sequence | None = None,
    electrons: int | None = None,
    accuracy: float | str | None = None,
    accuracy_floor: float | None = None,
    time: float | str | None = None,
    current: float | str | None = None,
    dwell: float | str | None = None,
    method: Literal['auto', 'direct', 'replay'] | None = None,
    mesh_tolerance: float | str = '0nm',
    detector: str | float | Sequence | None = None,
    physics: str | Mapping[str, str] | None = None,
    cutoff: float | str = '0eV',
    seed: int = 1,
    estimate: Literal['plain', 'guided', 'auto'] | None = None,
    guide_model: PathLike | None = None,
    threads: int | None = None,
    cache: PathLike | None = None,
    channels: str | float | Sequence | None = None,
    deposit: int | None = None,
    trajectories: int | None = None,
    trajectories_at: str | float | Sequence | None = None,
    spectra: bool = False,
    png_channel: str | None = None,
    layout: Literal['auto', 'rows', 'tiles'] | None = None,
) -> Findings:
    """Simulations over a grid of settings: energies, tilts, focus."""


def chart(
    specimen: PathLike | Mesh | HeightField | ArrayLike | Sequence,
    *,
    progress: bool | Callable[[float, float, str], object] | None = None,
    output: PathLike | None = None,
    quick: bool = False,
    methods: str | float | Sequence | None = None,
    seed: int = 1,
    threads: int | None = None,
    accuracy: float | str = '1%',
    reference: float | str | None = None,
    compared: int = 1000,
    most: float = 3e+08,
    surfaces: int = 20,
    surface_size: int = 64,
    draws: int | None = None,
    model: PathLike | None = None,
    material: str | None = None,
    materials: PathLike | Sequence[PathLike] | None = None,
    unit: str | None = None,
    override_unit: bool = False,
    substrate: str | None = None,
    substrate_z: float | str | None = None,
    edge: Literal['mirror', 'flat', 'periodic'] | None = None,
    height_channel: str | None = None,
    height_unit: float | str | None = None,
    height_pitch: float | str | None = None,
    energy: float | str = '1keV',
    tilt: float | str = '0deg',
    azimuth: float | str = '0deg',
    spot: float | str = '0nm',
    convergence: float | str = '0deg',
    focus: float | str = '0nm',
    working_distance: float | str = '0nm',
    size: str | float | Sequence | None = None,
    pixel_size: float | str | None = None,
    region: str | float | Sequence | None = None,
    physics: str | Mapping[str, str] | None = None,
    cutoff: float | str = '0eV',
) -> Findings:
    """Time against error of every method, on a scene or a sample of yours."""


def view(
    items: PathLike | HeightField | Mesh | Image | Tip | ArrayLike | Sequence | dict,
    output: PathLike,
    *,
    title: str | None = None,
    drape: PathLike | Image | tuple[Image, str] | None = None,
    scalar: PathLike | Image | tuple[Image, str] | list | dict | None = None,
    progress: bool | Callable[[float, float, str], object] | None = None,
    mesh_tolerance: float | str | None = None,
    every: int = 1,
    pixel_size: float | str | None = None,
    unit: str | None = None,
    override_unit: bool = False,
    height_unit: float | str | None = None,
    height_pitch: float | str | None = None,
    threads: int | None = None,
) -> Findings:
    """One web page that shows surfaces and images to anybody."""


def compare(
    before: PathLike | HeightField | Mesh | ArrayLike,
    after: PathLike | HeightField | Mesh | Image | ArrayLike,
    *,
    progress: bool | Callable[[float, float, str], object] | None = None,
    registered: bool = False,
    largest_shift: float | str | None = None,
    least_overlap: float | str = '50%',
    before_deviation: float | str | None = None,
    after_deviation: float | str | None = None,
    false_alarms: float | str = '5%',
    largest_window: float | str | None = None,
    smallest_window: int = 2,
    simulations: int = 0,
    model_error: float | str = '5%',
    seed: int = 1,
    energy: float | str | None = None,
    spot: float | str | None = None,
    physics: str | Mapping[str, str] | None = None,
    model: PathLike | None = None,
    signal: str | None = None,
    cache: PathLike | None = None,
    threads: int | None = None,
    no_picture: bool = False,
    output: PathLike | None = None,
    material: str | None = None,
    materials: PathLike | Sequence[PathLike] | None = None,
    unit: str | None = None,
    override_unit: bool = False,
    height_channel: str | None = None,
    height_unit: float | str | None = None,
    height_pitch: float | str | None = None,
    sem_channel: str | None = None,
    pixel_size: float | str | None = None,
) -> Findings:
    """Where a surface differs from another beyond their errors."""


def refine(
    start: PathLike | Mesh | HeightField | ArrayLike,
    sem: PathLike | Image | ArrayLike | Sequence,
    *,
    progress: bool | Callable[[float, float, str], object] | None = None,
    material: str | None = None,
    materials: PathLike | Sequence[PathLike] | None = None,
    unit: str | None = None,
    override_unit: bool = False,
    sem_channel: str | None = None,
    pixel_size: float | str | None = None,
    energy: float | str | None = None,
    spot: float | str = '0nm',
    physics: str | Mapping[str, str] | None = None,
    tilt: str | float | Sequence | None = None,
    azimuth: str | float | Sequence | None = None,
    view_signal: str | float | Sequence | None = None,
    tilt_error: float | str = '0.2deg',
    substrate: float | str | None = None,
    start_error: float | str = '10nm',
    height_error: float | str = '10nm',
    bump_error: float | str = '3nm',
    bump_length: float | str = '20nm',
    edge: float | str | None = None,
    spacing: float | str | None = None,
    smooth_rounds: int = 3,
    bump_rounds: int = 2,
    electrons: int = 200,
    effect_electrons: int = 40,
    model_error: float | str = '6%',
    seed: int = 1,
    cache: PathLike | None = None,
    threads: int | None = None,
    no_picture: bool = False,
    output: PathLike | None = None,
) -> Findings:
    """Let a mesh, undercuts included, agree with SEM images from several sides."""


def write_mesh(
    path: PathLike,
    mesh: Mesh | PathLike | Sequence | dict,
    *,
    scalars: dict[str, ArrayLike | Image | tuple[Image, str]] | None = None,
    drape: Image | PathLike | tuple[Image, str] | None = None,
    tracks: Sequence[Findings] | PathLike | None = None,
    unit: str | None = None,
) -> None:
    """Write a mesh, or several, to a file."""


def read_bodies(
    path: PathLike,
    *,
    unit: str | None = None,
    override_unit: bool = False,
) -> list[Mesh]:
    """Read the bodies of a mesh file, each by itself."""
