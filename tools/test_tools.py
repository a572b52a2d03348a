"""Tests that each tool accepts valid input and rejects faults."""

import contextlib
import io
import json
import unittest
from pathlib import Path

import arrows
import hygiene
import licences
import modules
import workspace


def package(name, *dependencies, licence="MIT"):
    """A package as `cargo metadata` describes it; a dependency is (name, kind) or (name, kind, source)."""
    described = []
    for target, kind, *source in dependencies:
        described.append({"name": target, "kind": kind, "source": source[0] if source else None})
    return {"name": name, "version": "1.0.0", "id": name, "license": licence, "dependencies": described}


def metadata(*packages, others=()):
    """Metadata of a workspace of the packages, and of others that are not in it."""
    return {"packages": [*packages, *others], "workspace_members": [package["id"] for package in packages]}


class TestData(unittest.TestCase):
    def test_its_size_is_bounded(self):
        self.assertEqual(list(hygiene.test_data_faults(10 << 20)), [])
        self.assertEqual(len(list(hygiene.test_data_faults((10 << 20) + 1))), 1)


class Arrows(unittest.TestCase):
    library = package("roughcast", ("half", None, "registry"), ("image", "dev", "registry"))

    def faults(self, *packages):
        return arrows.faults(metadata(self.library, *packages))

    def test_allowed_arrows_pass(self):
        reader = package("roughcast-io", ("roughcast", None), ("png", None, "registry"))
        program = package("roughcast-cli", ("roughcast", None), ("roughcast-io", "build"), ("roughcast-io", "dev"))
        scene = package("roughcast-scene", ("roughcast", None), ("roughcast-io", "dev"))
        self.assertEqual(self.faults(reader, program, scene), [])

    def test_an_arrow_that_runs_back_fails(self):
        reader = package("roughcast-io", ("roughcast-cli", None))
        program = package("roughcast-cli", ("roughcast-io", None))
        self.assertEqual(self.faults(reader, program), ["roughcast-io -> roughcast-cli: this arrow is not allowed"])

    def test_build_and_test_arrows_count(self):
        reader = package("roughcast-io")
        for kind in ["build", "dev"]:
            library = package("roughcast", ("roughcast-io", kind))
            self.assertEqual(len(arrows.faults(metadata(library, reader))), 1, kind)

    def test_what_tests_may_programs_may_not(self):
        scene = package("roughcast-scene", ("roughcast-io", None))
        self.assertEqual(len(self.faults(package("roughcast-io"), scene)), 1)

    def test_the_description_of_a_scene_is_taken_without_the_renderer(self):
        scene = package("roughcast-scene")
        bare, default, feature, tests = (package("roughcast-gpu", ("roughcast-scene", None)) for _ in range(4))
        self.assertEqual(self.faults(scene, bare), [])
        default["dependencies"][0]["uses_default_features"] = True
        feature["dependencies"][0]["features"] = ["render"]
        tests["dependencies"][0].update(kind="dev", features=["render"])
        for user in [default, feature]:
            self.assertIn("takes no features", self.faults(scene, user)[0])
        self.assertEqual(self.faults(scene, tests), [])

    def test_an_unknown_crate_fails(self):
        self.assertIn("unknown crate", self.faults(package("roughcast-extra"))[0])

    def test_a_path_outside_the_workspace_fails(self):
        self.assertIn("outside", self.faults(package("roughcast-io", ("elsewhere", None)))[0])

    def test_a_further_dependency_of_the_library_fails(self):
        for kind in [None, "build"]:
            library = package("roughcast", ("serde_json", kind, "registry"))
            self.assertIn("roughcast -> serde_json", arrows.faults(metadata(library))[0])

    def test_what_the_library_offers_is_optional(self):
        library = package("roughcast", ("serde", None, "registry"))
        self.assertIn("must be optional", arrows.faults(metadata(library))[0])
        library["dependencies"][0]["optional"] = True
        self.assertEqual(arrows.faults(metadata(library)), [])

    def test_a_workspace_without_the_library_fails(self):
        self.assertEqual(len(arrows.faults(metadata(package("roughcast-io")))), 1)


class Modules(unittest.TestCase):
    exports = modules.exports_of("pub use image::{Image, Samples};\npub use options::Options;\n")

    def faults(self, **files):
        named = [(Path(name.replace("__", "/") + ".rs"), text) for name, text in files.items()]
        return list(modules.faults(modules.arrows_of(named, self.exports)))

    def test_one_direction_passes(self):
        self.assertEqual(self.faults(image="", options="use crate::Image;", bake__mod="use crate::options::Options;"), [])

    def test_a_circle_fails_however_names_are_written(self):
        for back in ["use crate::options::Options;", "use crate::{Image, Options};", "fn f(o: crate::Options) {}"]:
            self.assertEqual(len(self.faults(options="use crate::texture::Layout;", texture__layout=back)), 2, back)

    def test_a_longer_circle_fails(self):
        self.assertEqual(len(self.faults(a="use crate::b::B;", b="use crate::c::C;", c="use crate::a::A;")), 3)

    def test_code_after_a_declared_file_of_tests_counts(self):
        back = "#[cfg(test)]\nmod tests;\n\nuse crate::options::Options;\n"
        self.assertEqual(len(self.faults(options="use crate::texture::Layout;", texture__mod=back)), 2)

    def test_comments_and_unit_tests_are_free(self):
        free = "/// [`crate::options`]\nstruct A;\n#[cfg(test)]\nmod tests {\n    use crate::options::Options;\n}\n"
        self.assertEqual(self.faults(options="use crate::texture::Layout;", texture=free), [])


class Licences(unittest.TestCase):
    def test_satisfied_expressions(self):
        for expression in [
            "MIT",
            "MIT/Apache-2.0",
            "GPL-3.0-only OR MIT",
            "MIT OR Apache-2.0 OR LGPL-2.1-or-later",
            "(MIT OR Apache-2.0) AND Unicode-3.0",
            "Apache-2.0 WITH LLVM-exception OR GPL-3.0-only",
            "GPL-2.0-only AND MIT OR Zlib",
            "((ISC))",
        ]:
            self.assertTrue(licences.is_satisfied(expression), expression)

    def test_expressions_that_are_not_satisfied(self):
        for expression in [
            "GPL-3.0-only",
            "MIT AND GPL-3.0-only",
            "GPL-3.0-only/AGPL-3.0-only",
            "(MIT OR Apache-2.0) AND MPL-2.0",
            "MIT AND (GPL-2.0-only OR LGPL-3.0-only)",
            "MIT WITH Unheard-of-exception",
            "Apache-2.0+",
        ]:
            self.assertFalse(licences.is_satisfied(expression), expression)

    def test_what_is_no_expression(self):
        for expression in ["", "MIT OR", "(MIT", "MIT)", "MIT Apache-2.0", "OR MIT", "MIT, Zlib", "MIT WITH"]:
            with self.assertRaises(ValueError, msg=expression):
                licences.is_satisfied(expression)

    def test_faults_of_dependencies(self):
        own = package("roughcast", licence=None)
        right = [package("a"), package("b", licence="Zlib OR GPL-3.0-only")]

        def faults(*others):
            return licences.faults(licences.dependencies(metadata(own, others=others)))

        self.assertEqual(faults(*right), [])
        for licence in [None, "", "GPL-3.0-only", "MIT OR"]:
            self.assertEqual(len(faults(*right, package("c", licence=licence))), 1, licence)

    def test_faults_of_npm_packages(self):
        def faults(licence):
            described = {"version": "1.0.0", "license": licence} if licence else {"version": "1.0.0"}
            packages = {"": {"name": "own"}, "node_modules/a": {"version": "2.0.0", "license": "MIT"}}
            packages["node_modules/a/node_modules/@scope/b"] = described
            return licences.faults(licences.npm_dependencies({"lockfileVersion": 3, "packages": packages}))

        self.assertEqual(faults("Apache-2.0"), [])
        self.assertEqual(faults(None), ["@scope/b 1.0.0: states no licence"])
        self.assertIn("@scope/b 1.0.0: 'GPL-3.0-only'", faults("GPL-3.0-only")[0])


class Hygiene(unittest.TestCase):
    def faults(self, path, data):
        return list(hygiene.file_faults(Path(path), data if isinstance(data, bytes) else data.encode()))

    def test_size(self):
        self.assertEqual(self.faults("picture.png", b"\0" * hygiene.MAX_BYTES), [])
        self.assertEqual(len(self.faults("picture.png", b"\0" * (hygiene.MAX_BYTES + 1))), 1)

    def test_cargo_lock(self):
        crates_io = f'[[package]]\nname = "a"\nsource = "{hygiene.CRATES_IO}"\n'
        self.assertEqual(self.faults("Cargo.lock", crates_io), [])
        for source in [
            "git+https://github.com/someone/a#0123abc",
            "registry+https://mirror.example/index",
            "sparse+https://mirror.example/index/",
        ]:
            self.assertEqual(len(self.faults("fuzz/Cargo.lock", f'{crates_io}source = "{source}"\n')), 1, source)

    def test_cargo_configuration(self):
        self.assertEqual(self.faults(".cargo/config.toml", "[build]\n"), [])
        for table in ["[source.crates-io]", "[registries.other]", "[registry]"]:
            self.assertEqual(len(self.faults(".cargo/config.toml", f"{table}\n")), 1, table)

    def test_npm_lock(self):
        def lock(url):
            return json.dumps({"packages": {"node_modules/a": {"resolved": url, "funding": "https://a.example"}}})

        self.assertEqual(self.faults("web/package-lock.json", lock("https://registry.npmjs.org/a/-/a-1.tgz")), [])
        for url in ["https://mirror.example/a-1.tgz", "git+ssh://git@github.com/a/a.git#0"]:
            self.assertEqual(len(self.faults("web/package-lock.json", lock(url))), 1, url)

    def test_python_locks(self):
        for name in ["uv.lock", "requirements.txt", "requirements-dev.txt", "poetry.lock"]:
            self.assertEqual(self.faults(name, 'url = "https://files.pythonhosted.org/a.whl"'), [], name)
            self.assertEqual(len(self.faults(name, "--index-url http://mirror.example:3141/simple")), 1, name)

    def test_unfinished_code(self):
        for word in ["todo" + "!()", "unimplemented" + '!("later")', "// FIX" + "ME: later", "#[ignor" + "e]"]:
            self.assertEqual(len(self.faults("src/a.rs", f"fn a() {{}}\n{word}\n")), 1, word)
            self.assertEqual(self.faults("notes.md", word), [], "prose may speak of it")
        self.assertEqual(self.faults("src/a.rs", "// the ignored ones; a todo list"), [])

    def test_paths_of_a_machine(self):
        for path in ["/ho" + "me/someone/x", "/Us" + "ers/someone", "/ro" + "ot/.cargo", "C:\\Us" + "ers\\someone"]:
            self.assertEqual(len(self.faults("README.md", f"see {path}")), 1, path)
        self.assertEqual(self.faults("README.md", "https://a.example/ho" + "me/page and ./ro" + "ot/x"), [])


class Report(unittest.TestCase):
    def status(self, faults):
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            return workspace.report(faults, "fine")

    def test_the_exit_status_follows_the_faults(self):
        self.assertEqual(self.status([]), 0)
        self.assertEqual(self.status(["a fault"]), 1)


if __name__ == "__main__":
    unittest.main()
