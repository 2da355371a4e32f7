#include "finray/sensing/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
  EXPECT_EQ(scene.columns.at("Fz [N]"), "force_N");
  EXPECT_FALSE(Load("contacts: auto\n").contacts.has_value());
  EXPECT_TRUE(ReadScene(FINRAY_SOURCE_DIR "/configs/scenes/one_contact.yaml")
                  .columns.empty());
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
