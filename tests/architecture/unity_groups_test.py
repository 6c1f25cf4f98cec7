#!/usr/bin/env python3
"""Finds config/cmake/unity_groups.py every kind of name that two sources in one file could both declare?

    unity_groups_test.py PROJECT
"""
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROJECT = pathlib.Path(sys.argv.pop(1)).resolve()
sys.path.insert(0, str(PROJECT / "config/cmake"))
import unity_groups  # noqa: E402


def names_in(text):
    """What `text` declares, standing in an unnamed namespace of namespace yuragi."""
    found = unity_groups.local_names("namespace yuragi {\nnamespace {\n" + text + "\n}\n}\n")
    assert all(scope == "yuragi::" for scope, _ in found), found
    return {name for _, name in found}


def in_unnamed(text):
    return "namespace {\n" + text + "\n}\n"


class NamesOfOneSource(unittest.TestCase):
    def check(self, text, *names):
        self.assertEqual(names_in(text), set(names), text)

    def test_functions(self):
        self.check("int clamp(int value) { if (value) { return 1; } return 0; }", "clamp")
        self.check("[[gnu::always_inline]] inline float go_on(float a,\n float b) noexcept;", "go_on")
        self.check("std::map<int, std::vector<int>> read(std::span<const int> in) {}", "read")
        self.check("auto sum(int a) -> std::vector<int> { return {}; }", "sum")
        self.check("const char* text_of(Kind) { return R\"x(} int f() {)x\"; }", "text_of")
        self.check("unsigned char (*handler)(int) = nullptr;\nvoid after() {}", "handler", "after")

    def test_constants_and_variables(self):
        self.check("constexpr double kSpeed_m_s = 4.0;", "kSpeed_m_s")
        self.check("constexpr std::array<std::string_view, 2> kNames = {\"a;{\", \"b\"};", "kNames")
        self.check("constexpr std::array kRows{1'000, 2};\nint counts[3];", "kRows", "counts")
        self.check("double one = f(1, 2), other = 2;", "one", "other")
        self.check("const Table<(1 < 2)> kTable;", "kTable")
        self.check("std::atomic<bool> ended{false};\nconst auto later = [](int a) { return a; };", "ended", "later")

    def test_types(self):
        self.check("struct Point { double x, y; void move() {} };", "Point")
        self.check("class Server final : public Base<int> { class Inner {}; };", "Server")
        self.check("enum class Kind : std::uint8_t { kOne, kTwo };", "Kind")
        self.check("enum Kind { kOne, kTwo = 3 };", "Kind", "kOne", "kTwo")
        self.check("enum { kLimit = 5 };", "kLimit")
        self.check("struct Later;\nunion Bits { int a; float b; };", "Later", "Bits")
        self.check("using Bytes = std::vector<int>;", "Bytes = std :: vector < int >")

    def test_templates(self):
        self.check("template <class T, std::size_t N = 3> T twice(T value) { return value; }", "twice")
        self.check("template <class T> requires (sizeof(T) > 1) struct Box { T in; };", "Box")
        self.check("template <class T> concept Small = sizeof(T) < 9;", "Small")
        self.check("template <class T> constexpr T kZero = T(0);", "kZero")

    def test_what_declares_no_name_of_its_own(self):
        self.check("TEST(Suite, Name) { int inside = 1; }\nTEST_F(Suite, Other) {}")
        self.check("static_assert(sizeof(int) == 4);\nusing std::string;\nusing namespace std::literals;")
        self.check("void Outer::run(int a) {}\nOuter::Outer() : a_(1) {}")
        self.check("bool operator==(const A& a, const A& b) { return true; }")
        self.check("// int commented() {}\n/* int also() {} */\n#define MACRO(a) int a() {\n")

    def test_names_outside_unnamed_namespaces_do_not_count(self):
        text = "namespace yuragi {\nint shown() { return 1; }\nnamespace { int hidden; }\nclass Shown {};\n}\nint main() {}\n"
        self.assertEqual(unity_groups.local_names(text), {("yuragi::", "hidden")})

    def test_the_namespaces_around_are_told_apart(self):
        text = "namespace yuragi::sim {\nnamespace {\nint a;\nnamespace deep { int b; }\n}\n}"
        self.assertEqual(unity_groups.local_names(text), {("yuragi::sim::", "a"), ("yuragi::sim::deep::", "b")})


class GroupsOfTargets(unittest.TestCase):
    def groups(self, sources, targets=None):
        names = {source: unity_groups.local_names(text) for source, text in sources.items()}
        return unity_groups.groups_of(targets or [("room", list(sources))], names)

    def test_sources_without_a_clash_stay_together(self):
        groups = self.groups({"a": in_unnamed("int f();"), "b": in_unnamed("int g();"), "c": "int f();"})
        self.assertEqual(set(groups.values()), {0})

    def test_each_kind_of_clash_parts_two_sources(self):
        for one, other in (("int f() {}", "void f(double) {}"), ("constexpr int k = 1;", "constexpr double k = 2;"),
                           ("struct A {};", "enum class A { b };"), ("template <class T> T f(T);", "int f();"),
                           ("using A = int;", "using A = long;"), ("using A = int;", "struct A {};")):
            groups = self.groups({"a": in_unnamed(one), "b": in_unnamed(other), "c": in_unnamed("int other;")})
            self.assertNotEqual(groups["a"], groups["b"], (one, other))
            self.assertEqual(groups["a"], groups["c"])

    def test_the_same_alias_may_be_declared_again(self):
        groups = self.groups({"a": in_unnamed("using A = int;"), "b": in_unnamed("using A = int;")})
        self.assertEqual(set(groups.values()), {0})

    def test_sources_of_different_targets_do_not_clash(self):
        sources = {"a": in_unnamed("int f;"), "b": in_unnamed("int f;")}
        self.assertEqual(self.groups(sources, [("one", ["a"]), ("other", ["b"])]), {"a": 0, "b": 0})

    def test_as_few_groups_as_three_that_clash_need(self):
        groups = self.groups({name: in_unnamed("int f;") for name in "abc"} | {"d": in_unnamed("int g;")})
        self.assertEqual([groups[name] for name in "abcd"], [0, 1, 2, 0])


class TheScript(unittest.TestCase):
    def test_it_writes_cmake_for_targets_with_a_clash_alone(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            for source, text in (("a", "int f;"), ("b", "int f;"), ("c", "int g;")):
                (folder / f"{source}.cpp").write_text(in_unnamed(text), encoding="ascii")
            paths = {source: str(folder / f"{source}.cpp") for source in "abc"}
            listed = folder / "targets.txt"
            listed.write_text(f"clash\t{folder}\t{paths['a']}\t{paths['b']}\nfine\t{folder}\t{paths['a']}\t{paths['c']}\n", encoding="ascii")
            done = subprocess.run([sys.executable, PROJECT / "config/cmake/unity_groups.py", listed], capture_output=True, text=True,
                                  check=True)
        self.assertEqual(done.stdout.splitlines(), [
            "set_target_properties(clash PROPERTIES UNITY_BUILD_MODE GROUP)",
            f'set_source_files_properties("{paths["a"]}" TARGET_DIRECTORY clash PROPERTIES UNITY_GROUP 0)',
            f'set_source_files_properties("{paths["b"]}" TARGET_DIRECTORY clash PROPERTIES UNITY_GROUP 1)'])


class TheProject(unittest.TestCase):
    def test_each_source_is_read_to_its_end(self):
        count = 0
        for top in ("engine", "drivers", "daemon", "viewer", "simulators", "tests"):
            for source in (PROJECT / top).rglob("*.cpp"):
                count += len(unity_groups.local_names(source.read_text(encoding="utf-8")))
        print(f"\n{count} names in unnamed namespaces")
        self.assertGreater(count, 2000)


if __name__ == "__main__":
    unittest.main(verbosity=1)
