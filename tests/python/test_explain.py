"""`beambench explain`: its pages work in a real browser, without network."""

from __future__ import annotations

import time
from pathlib import Path

import pytest

from browser import Browser
from program import beambench, can_explain

pytestmark = pytest.mark.skipif(not can_explain(), reason="built without three.js")

READY = "document.body.dataset.ready"
STEP = "document.querySelector('.step h3').innerText"


def explained(folder: Path, scene: str, structures: str, *more: str) -> Path:
    """Writes a page and returns its path."""
    page = folder / "page.html"
    done = beambench("explain", scene, "--accel", structures, "-o", page, *more)
    assert done.returncode == 0, done.stderr
    return page


def shown(browser: Browser, page: Path, width: int = 1400, place: str = "") -> Browser:
    """Opens a page and waits until it has drawn everything."""
    browser.open(page, width=width)
    if place:
        browser.evaluate(f"location.hash = '{place}'; location.reload()")
        time.sleep(0.5)
    ends = time.monotonic() + 20
    while browser.evaluate(READY) != "yes":
        assert time.monotonic() < ends, browser.complaints
        time.sleep(0.05)
    browser.evaluate(
        "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))"
    )
    return browser


def texts(browser: Browser, selector: str) -> list[str]:
    """Returns the texts of all elements."""
    return browser.evaluate(
        f"[...document.querySelectorAll('{selector}')].map(each => each.innerText)"
    )


@pytest.fixture(scope="module")
def beam_page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page of beams over escena2."""
    return explained(tmp_path_factory.mktemp("beam"), "escena2", "beam")


@pytest.mark.parametrize("width", [400, 1400])
def test_a_page_works_without_network_and_complaints(
    chromium: Browser, beam_page: Path, width: int
) -> None:
    shown(chromium, beam_page, width)
    assert chromium.complaints == []
    fetched = [at for at in chromium.requests if not at.startswith(("data:", "blob:"))]
    assert fetched == [beam_page.as_uri()]
    assert chromium.evaluate("document.documentElement.scrollWidth") <= width
    assert chromium.evaluate("document.querySelectorAll('.stage canvas').length") == 1


def test_the_first_sentence_says_what_beams_save(chromium: Browser, beam_page: Path) -> None:
    shown(chromium, beam_page)
    sentence = chromium.evaluate("document.getElementById('sentence').innerText")
    assert "beams" in sentence
    assert "none of their rays was traced or tested" in sentence


def test_a_ray_is_followed_forward_and_back(chromium: Browser, beam_page: Path) -> None:
    shown(chromium, beam_page)
    chromium.evaluate(
        "document.querySelector('[type=range][aria-label=\"step of the ray\"]').value = 0"
    )
    last = chromium.evaluate(STEP)
    count = int(last.split(" of ")[1].split(":")[0])
    assert last.startswith(f"Step {count} of {count}")
    chromium.evaluate("document.querySelector('[aria-label=\"step back\"]').click()")
    assert chromium.evaluate(STEP).startswith(f"Step {count - 1} of {count}")
    chromium.evaluate("document.querySelector('[aria-label=\"step forward\"]').click()")
    assert chromium.evaluate(STEP) == last
    assert any("is met at t" in line for line in texts(chromium, ".step .hit"))


def test_a_click_on_the_map_selects_a_ray(chromium: Browser, beam_page: Path) -> None:
    shown(chromium, beam_page)
    before = texts(chromium, ".map > .note")
    chromium.evaluate(
        "(() => { const map = document.querySelector('.map canvas'); "
        "const box = map.getBoundingClientRect(); "
        "map.dispatchEvent(new PointerEvent('pointerdown', {clientX: box.left + 2, "
        "clientY: box.top + 2})); })()"
    )
    assert texts(chromium, ".map > .note") != before
    assert texts(chromium, ".map > .note")[0].startswith("Pixel (0, 0)")
    assert "The ray hits" in texts(chromium, ".step .note")[0]


def test_two_structures_follow_the_same_ray(chromium: Browser, tmp_path: Path) -> None:
    page = explained(tmp_path, "tetra:n=3", "samet,sah-bvh", "--resolution", "24x24")
    shown(chromium, page)
    assert chromium.complaints == []
    assert texts(chromium, ".structure h2") == ["samet", "sah-bvh"]
    pixels = texts(chromium, ".map > .note")
    assert len(pixels) == 2
    assert pixels[0].split(":")[0] == pixels[1].split(":")[0]
    hits = texts(chromium, ".step .note")
    assert hits[0] == hits[1], "both find the same hit"
    assert "ray-primitive tests with" in chromium.evaluate(
        "document.getElementById('sentence').innerText"
    )


@pytest.mark.parametrize(
    ("structure", "mode"), [("tile-beam", "tiles"), ("tile-beam", "pencil1"), ("samet", "steps")]
)
def test_maps_show_tiles_pencils_and_steps(
    chromium: Browser, tmp_path: Path, structure: str, mode: str
) -> None:
    page = explained(tmp_path, "escena1", structure, "--resolution", "40x32")
    shown(chromium, page)
    modes = chromium.evaluate(
        "[...document.querySelector('.map select').options].map(option => option.value)"
    )
    assert mode in modes
    chromium.evaluate(
        f"(() => {{ const choice = document.querySelector('.map select'); choice.value = '{mode}'; "
        "choice.dispatchEvent(new Event('change')); "
        "[...document.querySelectorAll('[type=checkbox]')].at(-1).click(); })()"
    )
    assert texts(chromium, ".legend li")
    assert chromium.complaints == []


def test_a_scene_of_50000_triangles_is_small_and_quick(chromium: Browser, tmp_path: Path) -> None:
    begun = time.monotonic()
    page = explained(tmp_path, "soup:triangles=50000", "sah-bvh")
    written = time.monotonic() - begun
    assert page.stat().st_size < 5e6
    shown(chromium, page)
    assert chromium.complaints == []
    # The limit is generous because other work may slow this machine down.
    assert written < 60


@pytest.mark.full
def test_large_scenes_are_decimated_and_the_page_says_so(chromium: Browser, tmp_path: Path) -> None:
    page = explained(tmp_path, "soup:triangles=210000", "voxel-grid", "--resolution", "8x8")
    shown(chromium, page)
    assert "of 210,000 triangles are shown" in texts(chromium, "#notes")[0]


def test_names_cannot_break_out_of_the_data(chromium: Browser, tmp_path: Path) -> None:
    scene = tmp_path / "<script>alert(1)<\\script>.obj"
    scene.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    page = explained(tmp_path, str(scene), "samet", "--resolution", "8x8")
    shown(chromium, page)
    assert chromium.complaints == []


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["tetra", "--accel", "samet,beam,embree", "-o", "x.html"], "one structure, or two"),
        (["tetra", "--accel", "samet", "-o", "x.html", "--resolution", "4000x4000"], "65536"),
        (["tetra", "--accel", "samet", "-o", "no/folder/x.html"], "no/folder"),
        (["tetra", "-o", "x.html"], "--accel"),
    ],
)
def test_what_cannot_be_shown_is_refused(tmp_path: Path, words: list[str], said: str) -> None:
    done = beambench("explain", *words, cwd=tmp_path)
    assert done.returncode == 2
    assert said in done.stderr
    assert list(tmp_path.iterdir()) == []
