#include "finray/scene/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "finray/io/error.h"
#include "temp_file.h"

namespace finray {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

Scene Load(const std::string& text) {
  const TempFolder folder;
  return ReadScene(folder.Write("scene.yaml", text));
}

TEST(SceneTest, Reads) {
  const Scene scene = Load(
      "schema_version: 1\ncontacts: 1\nfriction_coefficient: 0.2\n"
      "object: {shape: circle, radius_mm: 20}\n"
      "columns: {\"Fz [N]\": force_N}\n");
  EXPECT_EQ(scene.contacts, 1);
  EXPECT_EQ(scene.friction_coefficient, 0.2);
  EXPECT_EQ(scene.circle_radius_mm(), 20);
  ASSERT_EQ(scene.columns.rules.size(), 1u);
  EXPECT_EQ(scene.columns.rules[0].from, "Fz [N]");
  EXPECT_EQ(scene.columns.rules[0].to, "force_N");
  EXPECT_FALSE(Load("contacts: auto\n").contacts.has_value());
}

TEST(SceneTest, NoneOrOne) {
  EXPECT_EQ(Load("contacts: auto\n").most_contacts, 2);
  const Scene scene = Load("contacts: auto\nmost_contacts: 1\n");
  EXPECT_EQ(scene.most_contacts, 1);
  EXPECT_FALSE(scene.contacts);
  EXPECT_EQ(Load("most_contacts: 2\n").most_contacts, 2);
  const auto error = [](const std::string& text, const std::string& message) {
    EXPECT_THAT([&] { Load(text); },
                ThrowsMessage<InputError>(HasSubstr(message)));
  };
  error("most_contacts: 0\n", ":1:16: most_contacts: expected 1 or 2");
  error("most_contacts: 3\n", "expected 1 or 2");
  error("most_contacts: auto\n", "most_contacts");
  error("contacts: 1\nmost_contacts: 1\n", ":2:16: most_contacts: it is for");
}

TEST(SceneTest, BundledScenesAreWhatTheirNamesSay) {
  const std::string folder = FINRAY_SOURCE_DIR "/configs/scenes/";
  EXPECT_EQ(ReadScene(folder + "one_contact.yaml").contacts, 1);
  EXPECT_FALSE(ReadScene(folder + "auto.yaml").contacts);
}

TEST(SceneTest, ReadsObjects) {
  const Scene ellipse = Load(
      "object: {shape: ellipse, semi_axis_x_mm: 12, semi_axis_y_mm: 20,\n"
      "         spring: {stiffness_N_per_mm: 2.0, direction_deg: 180}}\n");
  const auto& axes = std::get<EllipseOutline>(ellipse.object->outline.shape());
  EXPECT_EQ(axes.semi_axis_x_mm, 12);
  EXPECT_EQ(axes.semi_axis_y_mm, 20);
  EXPECT_EQ(ellipse.object->spring->stiffness_N_per_mm, 2);
  EXPECT_EQ(ellipse.object->spring->direction_rad, M_PI);
  EXPECT_FALSE(ellipse.circle_radius_mm());

  const Scene polygon = Load(
      "object: {shape: rounded_polygon, fillet_radius_mm: 2.5,\n"
      "         vertices_mm: [[-8, 6], [8, 7.5], [9, -6], [-8, -6]]}\n");
  const auto& corners =
      std::get<RoundedPolygonOutline>(polygon.object->outline.shape());
  EXPECT_EQ(corners.fillet_radius_mm, 2.5);
  ASSERT_EQ(corners.vertices_mm.size(), 4u);
  EXPECT_EQ(corners.vertices_mm[0], Eigen::Vector2d(-8, -6));
  EXPECT_FALSE(polygon.object->spring);

  const Scene series = Load(
      "object: {shape: support_series, radius_mm: 18,\n"
      "         harmonics_mm: [[0, 0], [1.5, -0.5]]}\n");
  const auto& support =
      std::get<SupportOutline>(series.object->outline.shape());
  EXPECT_EQ(support.radius_mm, 18);
  EXPECT_EQ(support.harmonics_mm.at(1), Eigen::Vector2d(1.5, -0.5));

  for (const Scene& scene : {ellipse, polygon, series}) {
    const std::string text = ObjectToYaml(*scene.object);
    EXPECT_EQ(ObjectToYaml(*Load("object: " + text + "\n").object), text);
  }
}

TEST(SceneTest, BadObjectsNameTheirPlace) {
  const auto error = [](const std::string& object, const std::string& message) {
    EXPECT_THAT([&] { Load("contacts: 1\nobject: {" + object + "}\n"); },
                ThrowsMessage<InputError>(HasSubstr(message)));
  };
  error("shape: support_series, radius_mm: 9, harmonics_mm: [[0,0], [4, 0]]",
        "scene.yaml:2:61: harmonics_mm: the outline is not convex");
  error("shape: ellipse, radius_mm: 3", "scene.yaml:2:26: unknown key");
  error("shape: ellipse, semi_axis_y_mn: 3", "did you mean 'semi_axis_y_mm'?");
  error("shape: elipse", "(did you mean 'ellipse'?)");
  error("shape: circle, radius_mm: -3", "expected a number above 0");
  const std::string polygon =
      "shape: rounded_polygon, fillet_radius_mm: 1, vertices_mm: ";
  error(polygon + "[[0, 0], [1, 0, 2]]",
        "scene.yaml:2:77: vertices_mm[2]: expected two numbers");
  error(polygon + "[[0, 0], [1, x]]",
        "vertices_mm[2]: expected a number, found 'x'");
  error(polygon + "3", "vertices_mm: expected a list of pairs");
  error(polygon + "[[0, 0]]", "expected at least 2 vertices");
  error(polygon + "[[0, 0], [4, 0], [1, 1], [0, 4]]",
        "scene.yaml:2:68: vertices_mm: the vertices are not those of a convex");
  error("shape: rounded_polygon, vertices_mm: [[0, 0], [4, 0]]",
        "'fillet_radius_mm' is missing");
  error("shape: circle, radius_mm: 3, spring: {stiffness_N_mm: 2}",
        "(did you mean 'stiffness_N_per_mm'?)");
  error("shape: circle, radius_mm: 3, spring: {stiffness_N_per_mm: 0}",
        "expected a number above 0");
  error("shape: circle, radius_mm: 3, spring: {stiffness_N_per_mm: 1}",
        "'direction_deg' is missing");
}

TEST(SceneTest, ReadsMeasurementsAndSmoothing) {
  const Scene scene = Load(
      "object: {shape: circle, radius_mm: 20}\n"
      "measurements: {object_std_mm: 0.05}\n"
      "smoothing: {contact_std_mm: 0.5, normal_std_N: 0.2}\n");
  EXPECT_EQ(scene.object_std_mm, 0.05);
  ASSERT_TRUE(scene.smoothing);
  EXPECT_EQ(scene.smoothing->contact_mm, 0.5);
  EXPECT_EQ(scene.smoothing->normal_N, 0.2);
  EXPECT_FALSE(Load("contacts: 1\n").smoothing);
  EXPECT_FALSE(Load("contacts: 1\n").force_max_N);
  EXPECT_EQ(Load("force_max_N: 12\n").force_max_N, 12);
  EXPECT_FALSE(Load("contacts: 1\n").search_iteration_limit);
  EXPECT_EQ(Load("search_iteration_limit: 50\n").search_iteration_limit, 50);
  const auto error = [](const std::string& text, const std::string& message) {
    EXPECT_THAT([&] { Load(text); },
                ThrowsMessage<InputError>(HasSubstr(message)));
  };
  const std::string measured = "measurements: {object_std_mm: 0.05}\n";
  error(measured, ":1:31: object_std_mm: a measured object needs an object of");
  error("object: {shape: ellipse, semi_axis_x_mm: 1, semi_axis_y_mm: 2}\n" +
            measured,
        ":2:31: object_std_mm: a measured object needs an object of shape");
  error("contacts: 2\nobject: {shape: circle, radius_mm: 20}\n" + measured,
        "needs contacts: 1 or auto");
  error("measurements: {object_std_mm: 0}\n", "object_std_mm");
  error("force_max_N: 0\n", "force_max_N");
  error("search_iteration_limit: 0\n",
        ":1:25: search_iteration_limit: expected");
  error("search_iteration_limit: 1.5\n", "search_iteration_limit");
  error("presliding_mm: 0.001\nfriction_coefficient: 0.3\n",
        ":1:16: presliding_mm: it needs an object in the scene");
  error("smoothing: {contact_std_mm: 1}\n", "normal_std_N");
  error("smoothing: {contact_mm: 1, normal_std_N: 1}\n", "contact_std_mm");
}

TEST(SceneTest, ContactBeams) {
  EXPECT_TRUE(Load("contacts: 2\n").contact_beams.empty());
  for (const char* contacts : {"contacts: 2\n", "contacts: auto\n", ""}) {
    const Scene scene =
        Load(std::string(contacts) + "contact_beams: [front, back]\n");
    EXPECT_EQ(scene.contact_beams,
              (std::vector<Side>{Side::kFront, Side::kBack}));
    EXPECT_EQ(ContactBeamsToYaml(scene), "[front, back]");
    EXPECT_THAT(
        [&] { RefuseBackContacts(scene); },
        ThrowsMessage<InputError>(HasSubstr(
            "contact_beams: contacts on the back beam can be simulated only")));
  }
  RefuseBackContacts(Load("contact_beams: [front]\n"));
  const auto error = [](const std::string& text, const std::string& message) {
    EXPECT_THAT([&] { Load(text); },
                ThrowsMessage<InputError>(HasSubstr(message)));
  };
  error("contact_beams: [front, bakc]\n",
        "scene.yaml:1:24: contact_beams[2]: expected one of front, back, found "
        "'bakc' (did you mean 'back'?)");
  error("contact_beams: [[front]]\n",
        "contact_beams[1]: expected one of front, back, found a sequence");
  error("contact_beams: back\n",
        "scene.yaml:1:16: contact_beams: expected a list of words, found "
        "'back'");
  error("contacts: 1\ncontact_beams: [front, back]\n",
        "scene.yaml:2:16: contact_beams: expected one word for each of the 1 "
        "contacts, found 2");
  error("contact_beams: []\n", "expected 1 to 16 words, found 0");
  error("contact_beam: [back]\n", "(did you mean 'contact_beams'?)");
  error("object: {shape: circle, radius_mm: 3}\ncontact_beams: [back]\n",
        "scene.yaml:2:16: contact_beams: an object touches the front beam "
        "only");
}

TEST(SceneTest, RefusesWhatIsNotModelled) {
  EXPECT_THAT([] { Load("contcats: 1\n"); },
              ThrowsMessage<InputError>(
                  HasSubstr("scene.yaml:1:1: unknown key 'contcats' in the "
                            "file (did you mean 'contacts'?)")));
  EXPECT_THAT([] { Load("contacts: -1\n"); },
              ThrowsMessage<InputError>(HasSubstr("0 to 16, or auto")));
  EXPECT_THAT(
      [] { Load("object: {shape: square, radius_mm: 3}\n"); },
      ThrowsMessage<InputError>(HasSubstr("shape: expected one of circle")));
}

}  // namespace
}  // namespace finray
