"""What documents.py --check finds: old pictures, pictures by other hands, and pictures that no command draws."""
import pathlib
import subprocess
import tempfile
import unittest

import documents


class Documents(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.sources = pathlib.Path(self.temporary.name)
        self.write("viewer/gl/shaders/a.frag.glsl", "void main() { // light\n  color = 1.0;\n}\n")
        for picture in documents.PICTURES:
            self.write(picture, picture)
        self.write("README.md", "![A meadow](viewer/meadow.png)\n[plot](engine/wind/field.png) [afar](https://example.org/a.png)\n")
        subprocess.run(["git", "init", "-q", self.sources], check=True)
        subprocess.run(["git", "-C", self.sources, "add", "."], check=True)
        self.record()

    def tearDown(self):
        self.temporary.cleanup()

    def write(self, name, text):
        (self.sources / name).parent.mkdir(parents=True, exist_ok=True)
        (self.sources / name).write_text(text)

    def record(self):
        (self.sources / documents.RECORD).parent.mkdir(parents=True, exist_ok=True)
        shaders = documents.hash_of_shaders(self.sources)
        documents.write_record(self.sources, {picture: (shaders, documents.hash_of(self.sources / picture)) for picture in documents.PICTURES})

    def faults(self):
        return list(documents.faults_in(self.sources))

    def test_pictures_of_these_shaders_are_good(self):
        self.assertEqual(self.faults(), [])

    def test_comments_and_white_space_make_no_picture_old(self):
        self.write("viewer/gl/shaders/a.frag.glsl", "/* of\nall */ void main() {\n\n  color = 1.0; } // otherwise\n")
        self.assertEqual(self.faults(), [])

    def test_another_shader_makes_all_old_and_the_command_is_named(self):
        self.write("viewer/gl/shaders/a.frag.glsl", "void main() { color = 0.5; }\n")
        faults = self.faults()
        self.assertEqual(len(faults), len(documents.PICTURES))
        self.assertIn("run tests/pictures/documents.py build/test/bin viewer/meadow.png", faults[0])

    def test_a_picture_by_another_hand_or_that_is_missing_is_found(self):
        self.write("viewer/meadow.png", "another")
        (self.sources / "viewer/garden.webp").unlink()
        faults = self.faults()
        self.assertEqual(len(faults), 2)
        self.assertIn("viewer/meadow.png was not drawn by", faults[0])
        self.assertIn("viewer/garden.webp is missing", faults[1])

    def test_a_picture_that_no_command_draws_is_found(self):
        self.write("README.md", "![Another](viewer/another.jpg)\n")
        self.assertIn("README.md shows viewer/another.jpg, which no command draws", self.faults()[0])


if __name__ == "__main__":
    unittest.main()
