#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace ctpm::testing {

/// Hashes of one golden session under one physics revision.
struct GoldenRow {
  std::string_view session;           ///< structure and integrator as scenes name them; retired names stay
  std::array<std::uint64_t, 4> hash;  ///< of State after 100, 200, 300 and 400 ticks, beside those in which it waits
};

/// The golden sessions of one physics revision; from revision 8 on only those that are new or that changed.
struct GoldenRevision {
  std::int32_t revision;
  std::span<const GoldenRow> rows;
  std::uint64_t digest;  ///< golden_digest() over this revision and all before it
};

// A new revision appends a table. Never edit an existing table: its digest and those of all later revisions would no
// longer match.

inline constexpr GoldenRow kGoldenRevision1[] = {
    {"mass-spring, auto", {0xefee6ee3e3c82c33, 0xcb6ef3f14a3b1100, 0x7495e99c091d5c25, 0x35fb3c8ca2adad62}},
    {"angle-mass-spring, auto", {0x5fe471d4eec34656, 0x4acd7e036ec4f538, 0x6bb9f230ce2f27aa, 0x6ef5bdddbafd6cf0}},
    {"tpm, auto", {0x0d8961a1427bff72, 0x5b46da4ab226eaee, 0x14ad5411472d381a, 0xd3bdf3ac746f8969}},
    {"ctpm, auto", {0x0f05f2cae2d5becb, 0xa08711354d919cb7, 0x2210cd74c42569f9, 0x207e28ddaffd20f9}},
    {"tpm, backward-euler", {0xd58c913a3e35caa8, 0x37c19f6b07503b9b, 0x813c582609345124, 0xd5a04ea8985977a6}},
    {"angle-mass-spring, backward-euler",
     {0x9b88eb6b869a77f3, 0x22825923ef28dec9, 0x7735b62b909da568, 0x20ea9837deaa3594}},
    {"ctpm, extrapolated-euler", {0x2baaed97f1ff960d, 0x04d613eb611ff8f1, 0xf76240c4df9d0d5e, 0x750d056e83897034}},
};

inline constexpr GoldenRow kGoldenRevision2[] = {
    {"mass-spring, auto", {0x69e30ac3bd1ac37d, 0xce46bc4102e508b3, 0x79fdf055a0acd7bb, 0xd43b06cd3361466d}},
    {"angle-mass-spring, auto", {0x1abd2210e9380a41, 0xd8f25bf5440cb7a3, 0xece31d1faec28a0a, 0x93cb2f6293aa25ce}},
    {"tpm, auto", {0x09f48463866490a5, 0x0a6f151a19d7fc7f, 0xd6e4677e781d0d86, 0x9120df1aca025ccb}},
    {"ctpm, auto", {0xbb124eda2f240214, 0xd368910b9482f88b, 0x72c5d443a0f10c36, 0x692b097ae9cbefe8}},
    {"tpm, backward-euler", {0xa96074b0379faad7, 0x968ca46685dd9aee, 0x9fb2298a133a8092, 0x65c1d447661e118b}},
    {"angle-mass-spring, backward-euler",
     {0xc763299e0bb6a373, 0xbc618d074c9b15e5, 0x1a4a398489d302ca, 0xc784a38daa1aa437}},
    {"full, auto", {0x2b05c06b95a472fe, 0xf6c28450b5acbc90, 0x7b9fe33a665c0de2, 0x78610f9db02a43ec}},
    {"full, sdirk2", {0xea86a8ae0f8bddae, 0xfa46db8e64a30568, 0x0ae7c9f8858c5ac7, 0x249274725f3a0cb6}},
    {"ctpm, sdirk2", {0xab9834e13ef5e03a, 0x83d99c0f5e0da13c, 0x85d8915798f0e007, 0x0b5167087a7f4849}},
};

inline constexpr GoldenRow kGoldenRevision3[] = {
    {"mass-spring, auto", {0xff5959e6840950ea, 0xcafb19a134d3b3b0, 0x099b982dd8f9516a, 0x7ada6582e12ec694}},
    {"angle-mass-spring, auto", {0x42a8b7602b5e1cb4, 0x9269fe90d5e9297c, 0xc464acc9693a81a3, 0xdf2b9bf8b016ab7e}},
    {"tpm, auto", {0x336807a55bfc0e06, 0xe66969782c08d880, 0x30a58a1c8809e978, 0x89abeb9e362f3f56}},
    {"ctpm, auto", {0x82e654ed00f5d17f, 0xd40f1d30888879f6, 0x116fb8f535ac5d4d, 0xba8e5e85b027fd8c}},
    {"tpm, backward-euler", {0x26b72390ecf2bfbc, 0x1c5dbfa5152cccfe, 0xcf5b3e77cc4ef88f, 0xea171f72a431e856}},
    {"angle-mass-spring, backward-euler",
     {0xb8d9c62c17abeba7, 0xc84c97cb99ff6371, 0x5ee223bb405a0954, 0x7540c5eaa79723ca}},
    {"full, auto", {0x9bdf607e3db0b064, 0x163daea5f0d300ad, 0x8e2c0b52c632235d, 0x560f9b4fd577287e}},
    {"full, sdirk2", {0xdb93d8730dab7087, 0x40d8f2babb95f301, 0x8cea5fc399f34f59, 0xd337ba7b5be6420c}},
    {"ctpm, sdirk2", {0x05ceca875199c5c2, 0x430468061160fd0e, 0xf52a5a2a0716fc07, 0xe6d70a7d59cd4f48}},
    {"resisting, auto", {0x82e654ed00f5d17f, 0x35d648c6509574b1, 0x932f052297f2d620, 0xf3e3ad1a37ac5d27}},
    {"resisting, sdirk2", {0x05ceca875199c5c2, 0x7c70648a793e7e40, 0x983af1b0ec8eeb07, 0xb7b900c3d736182f}},
    {"soft and resisting, auto", {0x4a67bab17f0abbbd, 0x21788022db3accde, 0x3583b1eefaba43ab, 0x94c6a1517c13ea49}},
    {"skinned, auto", {0xf6be77f9eea6d6d8, 0x2962f33910c9a807, 0x47785013c0d248be, 0x824d2aa39507701c}},
    {"skinned, sdirk2", {0x9f8994731b53bb51, 0x25a080b294e3dd1b, 0x75e208187401f02e, 0xfb6c54689f2c84de}},
    {"soft and skinned, auto", {0xffc9bec4713e9af0, 0x8e00795e5c2a228c, 0x642fcb2bf6e7171f, 0x9049deb96907ebf7}},
};

inline constexpr GoldenRow kGoldenRevision4[] = {
    {"mass-spring, auto", {0x4f7c88c0735091e9, 0xcb948e9673393792, 0xa30a73ee4b0e9020, 0xcc392d25d840e338}},
    {"angle-mass-spring, auto", {0x53ed69ed47081f4a, 0x3ba5906091f6ab00, 0xea55f97b3a115628, 0x183020ee3d54457c}},
    {"tpm, auto", {0x95b2c39bf88f10f5, 0xe850d989fe7fca2b, 0xd04c81a983ad18c0, 0x427f026c417d2c6c}},
    {"ctpm, auto", {0x86612b474b543844, 0xd54cb124532ed93a, 0xb1d62b15ff828ba6, 0xf4784d58b7e74bca}},
    {"tpm, backward-euler", {0xd96fed922634d73e, 0x6b3212ffa72f2cc6, 0x89ac000358af6e59, 0xe7b60d5029355512}},
    {"angle-mass-spring, backward-euler",
     {0x97dc04d8b3a9dd1f, 0x03412e9ed39fb7c8, 0x53f14ae9795e3024, 0xfcdc4c05e9cd5793}},
    {"full, auto", {0xb6c71a93224b3c05, 0x532dc5c79cc197c6, 0x27ab0222c21021f4, 0xbff991f257064f24}},
    {"full, sdirk2", {0x2a0b2e3c0646e61e, 0x4b236292430c12aa, 0x58062e74f2597d8a, 0x47a8580d56181e35}},
    {"ctpm, sdirk2", {0xc81ac1fb69f16b20, 0x1a92a362ee9ad4e8, 0x976200844ede8504, 0x60c510ce851d690b}},
    {"resisting, auto", {0x86612b474b543844, 0xa41ce9a9358d8c0f, 0x9e7aa01979372e4c, 0x19893ec796e5533a}},
    {"resisting, sdirk2", {0xc81ac1fb69f16b20, 0x97f53f69bf233a0c, 0x582b6d2761eff4ea, 0x6085a5b7bedbd7c6}},
    {"soft and resisting, auto", {0xe836adcc7b03139a, 0x14ffcbac57e1a446, 0xa6dd8dc07e808c1a, 0xe039a5a90dee28f8}},
    {"skinned, auto", {0xf3bffb4aa45235bf, 0xff08ca1f164dc71c, 0xbff79ac19e1b34ad, 0xa16cc9616d726804}},
    {"skinned, sdirk2", {0xd560509f566aa971, 0x32c0c7be75a46620, 0xda3951a0d5974a4e, 0x34c5f22f2dc1cc00}},
    {"soft and skinned, auto", {0x2167393320c256c0, 0xb116154d53aabfa1, 0x06c423a451e0c032, 0x23a973f64c5f62ea}},
};

inline constexpr GoldenRow kGoldenRevision5[] = {
    {"mass-spring, auto", {0x4f7c88c0735091e9, 0xcb948e9673393792, 0x8bccdeb0cbf7f750, 0x93683cf2455820b7}},
    {"angle-mass-spring, auto", {0x53ed69ed47081f4a, 0x3ba5906091f6ab00, 0x03e8daa7c9bc6762, 0x475f7f76876de2b4}},
    {"tpm, auto", {0x95b2c39bf88f10f5, 0xe850d989fe7fca2b, 0x8183dd2dba40557d, 0x076e54c26db9c121}},
    {"ctpm, auto", {0x86612b474b543844, 0xd54cb124532ed93a, 0x30f0e63554ad156b, 0x6ef0193a2ca22689}},
    {"tpm, backward-euler", {0xd96fed922634d73e, 0x6b3212ffa72f2cc6, 0x55969d6760733a80, 0xff90ab7a1118e97d}},
    {"angle-mass-spring, backward-euler",
     {0x97dc04d8b3a9dd1f, 0x03412e9ed39fb7c8, 0xd9dba7d24cb77e0c, 0x1725db8166b57d64}},
    {"full, auto", {0xb6c71a93224b3c05, 0x532dc5c79cc197c6, 0x141ab2cefde9b286, 0x7d1d299ca12ba9be}},
    {"full, sdirk2", {0x2a0b2e3c0646e61e, 0x4b236292430c12aa, 0xcc19088628cc1b6e, 0x60a7325c51c90af1}},
    {"ctpm, sdirk2", {0xc81ac1fb69f16b20, 0x1a92a362ee9ad4e8, 0x3a2274f7d1e11ad6, 0xd8c2875e789b636a}},
    {"resisting, auto", {0x86612b474b543844, 0xa41ce9a9358d8c0f, 0x5b98e4180a65d7f1, 0xc4fe0da4063de6ed}},
    {"resisting, sdirk2", {0xc81ac1fb69f16b20, 0x97f53f69bf233a0c, 0x6c3d6fb56fba15dd, 0xc76193d62f345267}},
    {"soft and resisting, auto", {0xe836adcc7b03139a, 0x14ffcbac57e1a446, 0x81ae27b1e6cf5177, 0x337ce2df56e4439d}},
    {"skinned, auto", {0xf3bffb4aa45235bf, 0xff08ca1f164dc71c, 0xbff79ac19e1b34ad, 0xa16cc9616d726804}},
    {"skinned, sdirk2", {0xd560509f566aa971, 0x32c0c7be75a46620, 0xda3951a0d5974a4e, 0x34c5f22f2dc1cc00}},
    {"soft and skinned, auto", {0x2167393320c256c0, 0xb116154d53aabfa1, 0x06c423a451e0c032, 0x23a973f64c5f62ea}},
};

inline constexpr GoldenRow kGoldenRevision6[] = {
    {"mass-spring, auto", {0x4f7c88c0735091e9, 0xcb948e9673393792, 0x8bccdeb0cbf7f750, 0x93683cf2455820b7}},
    {"angle-mass-spring, auto", {0x53ed69ed47081f4a, 0x3ba5906091f6ab00, 0x03e8daa7c9bc6762, 0x475f7f76876de2b4}},
    {"tpm, auto", {0x95b2c39bf88f10f5, 0xe850d989fe7fca2b, 0x8183dd2dba40557d, 0x076e54c26db9c121}},
    {"ctpm, auto", {0x86612b474b543844, 0xd54cb124532ed93a, 0x30f0e63554ad156b, 0x6ef0193a2ca22689}},
    {"tpm, backward-euler", {0xd96fed922634d73e, 0x6b3212ffa72f2cc6, 0x55969d6760733a80, 0xff90ab7a1118e97d}},
    {"angle-mass-spring, backward-euler",
     {0x97dc04d8b3a9dd1f, 0x03412e9ed39fb7c8, 0xd9dba7d24cb77e0c, 0x1725db8166b57d64}},
    {"full, auto", {0xb6c71a93224b3c05, 0x532dc5c79cc197c6, 0x141ab2cefde9b286, 0x7d1d299ca12ba9be}},
    {"full, sdirk2", {0x2a0b2e3c0646e61e, 0x4b236292430c12aa, 0xcc19088628cc1b6e, 0x60a7325c51c90af1}},
    {"ctpm, sdirk2", {0xc81ac1fb69f16b20, 0x1a92a362ee9ad4e8, 0x3a2274f7d1e11ad6, 0xd8c2875e789b636a}},
    {"resisting, auto", {0x86612b474b543844, 0xa41ce9a9358d8c0f, 0x5b98e4180a65d7f1, 0xc4fe0da4063de6ed}},
    {"resisting, sdirk2", {0xc81ac1fb69f16b20, 0x97f53f69bf233a0c, 0x6c3d6fb56fba15dd, 0xc76193d62f345267}},
    {"soft and resisting, auto", {0xe836adcc7b03139a, 0x14ffcbac57e1a446, 0x81ae27b1e6cf5177, 0x337ce2df56e4439d}},
    {"skinned, auto", {0xf3bffb4aa45235bf, 0xff08ca1f164dc71c, 0xbff79ac19e1b34ad, 0xa16cc9616d726804}},
    {"skinned, sdirk2", {0xd560509f566aa971, 0x32c0c7be75a46620, 0xda3951a0d5974a4e, 0x34c5f22f2dc1cc00}},
    {"soft and skinned, auto", {0x2167393320c256c0, 0xb116154d53aabfa1, 0x06c423a451e0c032, 0x23a973f64c5f62ea}},
    {"touched cut, auto", {0xff890838b753aeda, 0xc2964c266f6d3dfa, 0xb8c9e4911a0fd0cf, 0xb40007e26600f6d0}},
    {"touched cut, sdirk2", {0xe75fab1ec41d085b, 0x49cacdcdbe8cd0a1, 0x97f9e151eb72a7ad, 0x3dd8cd05a20cf63c}},
    {"soft and touched cut, auto", {0xd5f884a9e30aa820, 0xa8ca57b2b3f9310e, 0x8c6bf93c08b9a3bd, 0x834f00d86a85c6d2}},
    {"two hands, auto", {0xc6c1d85d1512e690, 0x6d0f09b25ab908fc, 0x84fcef55e94d5d0c, 0xe7ea60bedce57717}},
    {"two hands, sdirk2", {0x017d86b191843b23, 0xd60070a505fb5dd4, 0xde872fe2c607efdd, 0x0564c2848685cd96}},
    {"soft and two hands, auto", {0x1180d4b4680c1d33, 0x782c33232b01b77d, 0xe7e7da8983e48de9, 0xd0a7e15f2a1b0299}},
};

inline constexpr GoldenRow kGoldenRevision7[] = {
    {"mass-spring, auto", {0x4f7c88c0735091e9, 0xcb948e9673393792, 0x8bccdeb0cbf7f750, 0x93683cf2455820b7}},
    {"angle-mass-spring, auto", {0x53ed69ed47081f4a, 0x3ba5906091f6ab00, 0x03e8daa7c9bc6762, 0x475f7f76876de2b4}},
    {"tpm, auto", {0x95b2c39bf88f10f5, 0xe850d989fe7fca2b, 0x8183dd2dba40557d, 0x076e54c26db9c121}},
    {"ctpm, auto", {0x86612b474b543844, 0xd54cb124532ed93a, 0x30f0e63554ad156b, 0x6ef0193a2ca22689}},
    {"tpm, backward-euler", {0xd96fed922634d73e, 0x6b3212ffa72f2cc6, 0x55969d6760733a80, 0xff90ab7a1118e97d}},
    {"angle-mass-spring, backward-euler",
     {0x97dc04d8b3a9dd1f, 0x03412e9ed39fb7c8, 0xd9dba7d24cb77e0c, 0x1725db8166b57d64}},
    {"full, auto", {0xb6c71a93224b3c05, 0x532dc5c79cc197c6, 0x141ab2cefde9b286, 0x7d1d299ca12ba9be}},
    {"full, sdirk2", {0x2a0b2e3c0646e61e, 0x4b236292430c12aa, 0xcc19088628cc1b6e, 0x60a7325c51c90af1}},
    {"ctpm, sdirk2", {0xc81ac1fb69f16b20, 0x1a92a362ee9ad4e8, 0x3a2274f7d1e11ad6, 0xd8c2875e789b636a}},
    {"resisting, auto", {0x86612b474b543844, 0xa41ce9a9358d8c0f, 0x5b98e4180a65d7f1, 0xc4fe0da4063de6ed}},
    {"resisting, sdirk2", {0xc81ac1fb69f16b20, 0x97f53f69bf233a0c, 0x6c3d6fb56fba15dd, 0xc76193d62f345267}},
    {"soft and resisting, auto", {0xe836adcc7b03139a, 0x14ffcbac57e1a446, 0x81ae27b1e6cf5177, 0x337ce2df56e4439d}},
    {"skinned, auto", {0xf3bffb4aa45235bf, 0xff08ca1f164dc71c, 0xbff79ac19e1b34ad, 0xa16cc9616d726804}},
    {"skinned, sdirk2", {0xd560509f566aa971, 0x32c0c7be75a46620, 0xda3951a0d5974a4e, 0x34c5f22f2dc1cc00}},
    {"soft and skinned, auto", {0x2167393320c256c0, 0xb116154d53aabfa1, 0x06c423a451e0c032, 0x23a973f64c5f62ea}},
    {"touched cut, auto", {0xff890838b753aeda, 0xc2964c266f6d3dfa, 0xb8c9e4911a0fd0cf, 0xb40007e26600f6d0}},
    {"touched cut, sdirk2", {0xe75fab1ec41d085b, 0x49cacdcdbe8cd0a1, 0x97f9e151eb72a7ad, 0x3dd8cd05a20cf63c}},
    {"soft and touched cut, auto", {0xd5f884a9e30aa820, 0xa8ca57b2b3f9310e, 0x8c6bf93c08b9a3bd, 0x834f00d86a85c6d2}},
    {"touched slice, auto", {0xc651e673aaed1229, 0xf5a083e760a53fea, 0x9275339255a1e1b3, 0xaed6550b75c79f8a}},
    {"touched slice, sdirk2", {0xfc009c869aa9e49a, 0xb6cc0faa904be811, 0xa34b70fa58bf96e4, 0xb48e13798b88ce4e}},
    {"soft and touched slice, auto", {0x0aebf3b27fba0d04, 0x48f5ebb3b9b1b20b, 0x83d59a6edd6063b3, 0xd798cd88496b9df4}},
    {"two hands, auto", {0xc6c1d85d1512e690, 0x6d0f09b25ab908fc, 0x84fcef55e94d5d0c, 0xe7ea60bedce57717}},
    {"two hands, sdirk2", {0x017d86b191843b23, 0xd60070a505fb5dd4, 0xde872fe2c607efdd, 0x0564c2848685cd96}},
    {"soft and two hands, auto", {0x1180d4b4680c1d33, 0x782c33232b01b77d, 0xe7e7da8983e48de9, 0xd0a7e15f2a1b0299}},
};

inline constexpr GoldenRow kGoldenRevision8[] = {
    {"touched tear, auto", {0xc651e673aaed1229, 0x2daa381a3a772e97, 0xbe7502bc1bb26592, 0x8f2d8d102004e736}},
    {"touched tear, sdirk2", {0xfc009c869aa9e49a, 0x8a72951a4f43bfe3, 0x1365cc7c70347b99, 0x901735766b9c034f}},
};

inline constexpr GoldenRow kGoldenRevision9[] = {
    {"light, backward-euler", {0xd3d3d238bbc81e70, 0xd3b269e181b3410a, 0xcfc6da4c3120636c, 0x73d7e9a42dfefb5f}},
    {"light, sdirk2", {0xd26734d372d4df92, 0x24a6390d14dc60ab, 0x1159ae17d99f51b3, 0xfa784d5da425ccfb}},
    {"touched cut, auto", {0xff890838b753aeda, 0xc2964c266f6d3dfa, 0x82de14cbeeabbe6b, 0xa61f321502892cf8}},
    {"touched cut, sdirk2", {0xe75fab1ec41d085b, 0x49cacdcdbe8cd0a1, 0x73a2c56abe6cd8e0, 0x29275c598d487113}},
    {"soft and touched cut, auto", {0xd5f884a9e30aa820, 0xa8ca57b2b3f9310e, 0xc5b9a9db06edb50d, 0x7724460a5538b08f}},
    {"touched slice, auto", {0xc651e673aaed1229, 0xf5a083e760a53fea, 0x9275339255a1e1b3, 0xd4861a2117eb6113}},
    {"touched slice, sdirk2", {0xfc009c869aa9e49a, 0xb6cc0faa904be811, 0xa34b70fa58bf96e4, 0x719b1733d6087fc4}},
    {"soft and touched slice, auto", {0x0aebf3b27fba0d04, 0x48f5ebb3b9b1b20b, 0x83d59a6edd6063b3, 0xae7beaf2056aac23}},
};

inline constexpr GoldenRow kGoldenRevision10[] = {
    {"touched plane, auto", {0x05c70d5366a0e86f, 0x21d13da372bbb391, 0x2b07f6a5bb943e4b, 0x0e7540672eaf5347}},
    {"touched plane, sdirk2", {0x37af568419ef2339, 0x882b573d001dd94a, 0xffda939d257c06b7, 0x8d9bbb10f6f0919f}},
};

inline constexpr GoldenRow kGoldenRevision11[] = {
    {"angle-mass-spring, auto", {0x53ed69ed47081f4a, 0x3ba5906091f6ab00, 0x03e8daa7c9bc6762, 0x5343195521929230}},
    {"touched edge, auto", {0x9b1c43367d2e1eef, 0x2ea98739cd4dc7ce, 0x54dfe5d556480858, 0x4a9efc1b5d76970e}},
    {"touched edge, sdirk2", {0xccc1a61582d3eac9, 0x7967bc15e25051f8, 0x41e7c1b99d7c3771, 0x34421e88bae98d8b}},
};

inline constexpr GoldenRow kGoldenRevision12[] = {
    {"full, auto", {0xb6c71a93224b3c05, 0x532dc5c79cc197c6, 0x0922fef65a623495, 0xe06caca2b11b3409}},
    {"full, sdirk2", {0x2a0b2e3c0646e61e, 0x4b236292430c12aa, 0xe7b05e8f9cc1578c, 0xb4e290deb5fdbec4}},
    {"light, backward-euler", {0xd3d3d238bbc81e70, 0xd3b269e181b3410a, 0x3b55a49b519bcfeb, 0x56a54a001e7af068}},
    {"light, sdirk2", {0xd26734d372d4df92, 0x24a6390d14dc60ab, 0x5f5d7a5e7901fd9d, 0x252c4f6dd5862a1b}},
};

inline constexpr GoldenRow kGoldenRevision13[] = {
    {"soft and touched cut, auto", {0xd5f884a9e30aa820, 0xa8ca57b2b3f9310e, 0xc5b9a9db06edb50d, 0x5abbea5c5948c251}},
    {"touched slice, auto", {0xc651e673aaed1229, 0xf5a083e760a53fea, 0x9275339255a1e1b3, 0xabf4040c330acb3e}},
    {"touched slice, sdirk2", {0xfc009c869aa9e49a, 0xb6cc0faa904be811, 0xa34b70fa58bf96e4, 0xcecb554ee8ba8656}},
    {"soft and touched slice, auto", {0x0aebf3b27fba0d04, 0x48f5ebb3b9b1b20b, 0x83d59a6edd6063b3, 0xddc48375d97b5719}},
    {"touched tear, auto", {0xc651e673aaed1229, 0x2daa381a3a772e97, 0xbe7502bc1bb26592, 0xcbd881d9dd5892ea}},
    {"touched tear, sdirk2", {0xfc009c869aa9e49a, 0x8a72951a4f43bfe3, 0x1365cc7c70347b99, 0xbcf23ddc1a2b54ac}},
    {"touched plane, auto", {0x05c70d5366a0e86f, 0x21d13da372bbb391, 0xcc929088b5f6d53a, 0xbea4b519a0b023f0}},
    {"touched plane, sdirk2", {0x37af568419ef2339, 0x882b573d001dd94a, 0xfdae0beae8e33f6e, 0x03b1369b1a02ea3a}},
};

inline constexpr GoldenRow kGoldenRevision14[] = {
    {"touched bridge, auto", {0xc651e673aaed1229, 0xe9e40072544d0154, 0x63cb3c28b5d7be6a, 0xcb3b7491d9815323}},
    {"touched bridge, sdirk2", {0xfc009c869aa9e49a, 0x50d838f595c1c99f, 0x8d35e7d96d411f5a, 0xb196401c900052a3}},
};

inline constexpr GoldenRow kGoldenRevision15[] = {
    {"full, auto", {0xb6c71a93224b3c05, 0x532dc5c79cc197c6, 0xcfd5eacf13d457bc, 0x16e9c74cf6074000}},
    {"full, sdirk2", {0x2a0b2e3c0646e61e, 0x4b236292430c12aa, 0xf8deca6d379b5100, 0x4e0184ba31493add}},
    {"wedge, auto", {0xb6c71a93224b3c05, 0x532dc5c79cc197c6, 0xae26d3f4f2e1c428, 0x06bc8fb3d94197b9}},
    {"wedge, sdirk2", {0x2a0b2e3c0646e61e, 0x4b236292430c12aa, 0x944dddb04c0a3826, 0x72afb1418b0f1ae7}},
    {"light, backward-euler", {0xd3d3d238bbc81e70, 0xd3b269e181b3410a, 0x6b65003f6a34f32c, 0x71a62c8979eb82ff}},
    {"light, sdirk2", {0xd26734d372d4df92, 0x24a6390d14dc60ab, 0x5893454633e39af3, 0x5a81ebdf3bbb1f6b}},
};

inline constexpr GoldenRow kGoldenRevision16[] = {
    {"crumbs, auto", {0x03283a5938717dbc, 0xc765e32a43836add, 0x2ccc8f73db031fc8, 0xfa42f56e05aa4a3a}},
    {"crumbs, sdirk2", {0xdac49de31b596afd, 0x07be4289609adc59, 0x47a2917b803875db, 0xc1c13e36d2fd9d85}},
    {"touched plane, auto", {0x05c70d5366a0e86f, 0x8387584449065cec, 0x3dbf141e8478bdbe, 0xe1584d881b3075e0}},
    {"touched plane, sdirk2", {0x37af568419ef2339, 0xa070be2e909e5e02, 0x5d69761500ef2a73, 0x2dad277c04a6754f}},
    {"touched edge, auto", {0x61cbf0e6f2fb833a, 0xc360c6b0e0a5d91e, 0xfff38ec03a529734, 0x8093801b5c807fcf}},
    {"touched edge, sdirk2", {0x9d4448529e209f43, 0x9cf078e437155cc0, 0x0ed4fb5cf05517bc, 0x11912acbc5736a47}},
};

inline constexpr GoldenRow kGoldenRevision17[] = {
    {"fine mesh, auto", {0x00c4c498b1ca5a4c, 0xdbc03d3839fc62ff, 0xdef9c83dcf2f7d31, 0xeb92fdea24765e6b}},
    {"fine mesh, sdirk2", {0x0deb52955a7f94bc, 0xcd0834d3da93624f, 0x7a73a7965dde6d5c, 0x394013e0edf693f8}},
};

inline constexpr GoldenRow kGoldenRevision18[] = {
    {"full, sdirk2", {0x6ea36172c291d416, 0x28c7a22f71fa0d6e, 0x0fac038bb4ce2238, 0x54c49f51d9160b69}},
    {"wedge, sdirk2", {0x6ea36172c291d416, 0x28c7a22f71fa0d6e, 0xce325186f67a2983, 0xf15e61d0419028c6}},
    {"crumbs, sdirk2", {0xc9cff25ee39accfa, 0x7d40b15903d27ca0, 0x3e6e7093b50a3f24, 0x3288adf1ec7cff40}},
    {"light, sdirk2", {0x3e3014ff5c07bebd, 0x61d4a96c854a89ea, 0x2e94aed372e2e8d8, 0x7aef5f074211e577}},
    {"resisting, sdirk2", {0x6899f40c7801179c, 0xf766374616859eb5, 0x3180feae6141686f, 0xf1524fc1ff2be7a6}},
    {"skinned, sdirk2", {0xb9afbe8c4d1d969f, 0x308d704159429bd0, 0xa56f73ff2ab4aef5, 0xe67a512010328272}},
    {"touched cut, sdirk2", {0xfff94fb4d8b04cb2, 0x9c3ab6f566ffcb22, 0xab39169340c55d1f, 0xb01e518b2ce63263}},
    {"touched slice, sdirk2", {0x7f2b67ca4ea3f792, 0xfa0514df994c3eb0, 0x843d60ce3c8c6d87, 0x515115f11d1f49aa}},
    {"touched tear, sdirk2", {0x7f2b67ca4ea3f792, 0xd38c18f8b4227a0c, 0xd037f8a86ee90194, 0x958e69d555874cc9}},
    {"touched bridge, auto", {0xc651e673aaed1229, 0xe9e40072544d0154, 0x5158d74c1e8e3d34, 0xb26a17d7861faedc}},
    {"touched bridge, sdirk2", {0x7f2b67ca4ea3f792, 0x0b74c9e55486259b, 0x2715ee5a27e686bf, 0x8e5c882838eadc3f}},
    {"touched plane, auto", {0x05c70d5366a0e86f, 0x8387584449065cec, 0x13826faecd58d325, 0x7cf5913f8b96312a}},
    {"touched plane, sdirk2", {0x943a47562b9eb657, 0xe532eaa507a2ec22, 0x6228cbce96be887f, 0xe550f5bb389186b4}},
    {"touched edge, sdirk2", {0x4e25e343a3f4899d, 0xfb43f3c94afbfcf2, 0x650568df146b82b5, 0x15f3bb88377ffa00}},
    {"two hands, sdirk2", {0x2dd376e2afb8ca46, 0x4b8af5b88a0ea494, 0xbb3a72eb1d710295, 0x53aec9069f5d9d65}},
    {"fine mesh, sdirk2", {0xfbc106aac38946d1, 0xfb23e1304eedba24, 0x416142254c0f4879, 0xbed2098026f775ab}},
    {"ctpm, sdirk2", {0x6899f40c7801179c, 0x73fb27f2c577f149, 0x5c9f5790d6ca71ff, 0x43f589910cc09c2a}},
    {"full, auto", {0xb6c71a93224b3c05, 0x532dc5c79cc197c6, 0x96234d85fe4e805a, 0x4c8aebf7e947abc4}},
    {"wedge, auto", {0xb6c71a93224b3c05, 0x532dc5c79cc197c6, 0xfd32b4f8bf51c431, 0x3f7d5218206103cc}},
    {"crumbs, auto", {0xfc79f730a0b68a42, 0xa173afeacad1bb38, 0x11c8e4685a0603e1, 0xf59e732ac9072487}},
};

inline constexpr GoldenRow kGoldenRevision19[] = {
    {"full, sdirk2", {0x6ea36172c291d416, 0x28c7a22f71fa0d6e, 0x6c15fe1e9c02670d, 0xfe51023178cdb6c7}},
    {"wedge, sdirk2", {0x6ea36172c291d416, 0x28c7a22f71fa0d6e, 0xe18bcdb8edf6db92, 0x27ee5c172b680e7b}},
    {"crumbs, sdirk2", {0x145bf676d9ef7105, 0xa3adb7363227e7b0, 0x52fa7f9858cc037a, 0x8fac456bc4675a75}},
    {"skinned, auto", {0xf3bffb4aa45235bf, 0x25a1b6eb1475d9c9, 0xe5a7299fc71a7f5c, 0xb66de7471d493ca1}},
    {"skinned, sdirk2", {0xb9afbe8c4d1d969f, 0xf8a40e4e53f79665, 0xa56f73ff2ab4aef5, 0xe67a512010328272}},
    {"soft and skinned, auto", {0x2167393320c256c0, 0x973dd11779446504, 0xc249817082a8a727, 0x16c22e699f655a13}},
    {"touched cut, auto", {0xff890838b753aeda, 0xc2964c266f6d3dfa, 0x1c04606c5c38b838, 0xd9bb3ac7c7116629}},
    {"touched cut, sdirk2", {0xfff94fb4d8b04cb2, 0x9c3ab6f566ffcb22, 0xea0f67111354a57c, 0x9b690c1a18af2bf5}},
    {"soft and touched cut, auto", {0xd5f884a9e30aa820, 0xa8ca57b2b3f9310e, 0x654555a6f5270cb1, 0x24ec8e770d0a0134}},
    {"touched slice, auto", {0xc651e673aaed1229, 0xf5a083e760a53fea, 0x9275339255a1e1b3, 0x5a104496c65a8784}},
    {"touched slice, sdirk2", {0x7f2b67ca4ea3f792, 0xfa0514df994c3eb0, 0x843d60ce3c8c6d87, 0x86636c1211451d91}},
    {"soft and touched slice, auto", {0x0aebf3b27fba0d04, 0x48f5ebb3b9b1b20b, 0x83d59a6edd6063b3, 0xd9802505b787f981}},
    {"touched tear, auto", {0xc651e673aaed1229, 0x2daa381a3a772e97, 0xbe7502bc1bb26592, 0xe160cacbc3b231b8}},
    {"touched tear, sdirk2", {0x7f2b67ca4ea3f792, 0xd38c18f8b4227a0c, 0xd037f8a86ee90194, 0x0e8897caf112b507}},
    {"touched bridge, auto", {0xc651e673aaed1229, 0xe9e40072544d0154, 0xc80fbf694c561f34, 0xbbd003389a0b91a4}},
    {"touched bridge, sdirk2", {0x7f2b67ca4ea3f792, 0x0b74c9e55486259b, 0xf4162d93724331c1, 0xa930c695355b0820}},
    {"touched plane, auto", {0x05c70d5366a0e86f, 0x8387584449065cec, 0xdb05af94c6e3a545, 0x88735788c1380397}},
    {"touched plane, sdirk2", {0x943a47562b9eb657, 0xe532eaa507a2ec22, 0x848d0075bf83c5af, 0x6d31321e1cbf47cc}},
    {"touched edge, auto", {0x61cbf0e6f2fb833a, 0xc360c6b0e0a5d91e, 0xfff38ec03a529734, 0xaf33a6c4529681de}},
    {"touched edge, sdirk2", {0x4e25e343a3f4899d, 0xfb43f3c94afbfcf2, 0x650568df146b82b5, 0xb7e4ad4851092af9}},
    {"fine mesh, auto", {0x00c4c498b1ca5a4c, 0x35bd65f3863eb426, 0xe4ec4d231240d073, 0x428d034685f903e5}},
    {"fine mesh, sdirk2", {0xfbc106aac38946d1, 0x5e23372e127a8dae, 0x416142254c0f4879, 0xbed2098026f775ab}},
    {"full, auto", {0xb6c71a93224b3c05, 0x532dc5c79cc197c6, 0xcfd5eacf13d457bc, 0x16e9c74cf6074000}},
    {"wedge, auto", {0xb6c71a93224b3c05, 0x532dc5c79cc197c6, 0xae26d3f4f2e1c428, 0x06bc8fb3d94197b9}},
    {"crumbs, auto", {0x03283a5938717dbc, 0xc765e32a43836add, 0x2ccc8f73db031fc8, 0xfa42f56e05aa4a3a}},
};

inline constexpr GoldenRow kGoldenRevision20[] = {
    {"long strip, auto", {0xc3ccc9ebd4337fbc, 0x2e6ae804277ed0e6, 0xbe4319aa63664aa3, 0xd779e6a055efa62e}},
    {"long strip, sdirk2", {0xb5f19139939278c6, 0x654ac779d07b4bbc, 0x30476eec26064ff4, 0x1a7d0e95ce6e878d}},
    {"skinned, auto", {0xf3bffb4aa45235bf, 0xbbffa7c592df0094, 0x59b8634aa617a94a, 0x7076546a9f2848d6}},
    {"skinned, sdirk2", {0xb9afbe8c4d1d969f, 0x7d1de38ecca79ea1, 0xa56f73ff2ab4aef5, 0xe67a512010328272}},
    {"soft and skinned, auto", {0x2167393320c256c0, 0x73785f893fc58b4a, 0xfe88867b487f85f0, 0x3062fbd72d5c0dce}},
    {"touched cut, auto", {0xff890838b753aeda, 0xc2964c266f6d3dfa, 0xbb542c937faa159f, 0x5c8efdcaf7e5880b}},
    {"touched cut, sdirk2", {0xfff94fb4d8b04cb2, 0x9c3ab6f566ffcb22, 0x58b88fd24dff4b45, 0xf8b2a4c3b3b10966}},
    {"soft and touched cut, auto", {0xd5f884a9e30aa820, 0xa8ca57b2b3f9310e, 0x560b536dcb62bbec, 0xa1c2298fec92b5c9}},
    {"touched slice, auto", {0xc651e673aaed1229, 0xf5a083e760a53fea, 0x9275339255a1e1b3, 0xef80760466ad88c4}},
    {"touched slice, sdirk2", {0x7f2b67ca4ea3f792, 0xfa0514df994c3eb0, 0x843d60ce3c8c6d87, 0x1f0232232bc9e095}},
    {"soft and touched slice, auto", {0x0aebf3b27fba0d04, 0x48f5ebb3b9b1b20b, 0x83d59a6edd6063b3, 0xeee4cde18110e2d7}},
    {"touched tear, auto", {0xc651e673aaed1229, 0x2daa381a3a772e97, 0xbe7502bc1bb26592, 0x5ccfe652f6cddebc}},
    {"touched tear, sdirk2", {0x7f2b67ca4ea3f792, 0xd38c18f8b4227a0c, 0xd037f8a86ee90194, 0x425b5e9aeb6c1a7f}},
    {"touched bridge, auto", {0xc651e673aaed1229, 0xe9e40072544d0154, 0xfd1e5fa8eae3f2cc, 0x6b4942d5d00923e4}},
    {"touched bridge, sdirk2", {0x7f2b67ca4ea3f792, 0x0b74c9e55486259b, 0x2375d7e2f4777d49, 0xd1ff29edc5134d79}},
    {"touched plane, auto", {0x05c70d5366a0e86f, 0x8387584449065cec, 0x0c133ab6d800e748, 0x11c7a1e8879435ab}},
    {"touched plane, sdirk2", {0x943a47562b9eb657, 0xe532eaa507a2ec22, 0xd3f8e1be82af0675, 0x132717d94758c771}},
    {"touched edge, auto", {0x61cbf0e6f2fb833a, 0xc360c6b0e0a5d91e, 0xfff38ec03a529734, 0xb2504926071a0056}},
    {"touched edge, sdirk2", {0x4e25e343a3f4899d, 0xfb43f3c94afbfcf2, 0x650568df146b82b5, 0x633f398a727e96fd}},
    {"fine mesh, auto", {0x00c4c498b1ca5a4c, 0x61b0fff1042a87b0, 0x70ee73baaa9e928d, 0x7ad86f1fda0f365b}},
    {"fine mesh, sdirk2", {0xfbc106aac38946d1, 0x970261862069dfd3, 0x416142254c0f4879, 0xbed2098026f775ab}},
};

inline constexpr GoldenRow kGoldenRevision21[] = {
    {"long strip, auto", {0x6807633ce95d942c, 0xeecaa8ada689fdf3, 0x2da9c25789907454, 0xce81b4d15a1017f2}},
    {"long strip, sdirk2", {0x8c6d2a8332d9ea84, 0xcc0315ee2ddde686, 0x8b4640d5c2e6e437, 0xd4c8c382916ee39b}},
    {"skinned, auto", {0xf3bffb4aa45235bf, 0xbbffa7c592df0094, 0x59b8634aa617a94a, 0x7ddf3f654e624099}},
    {"skinned, sdirk2", {0xb9afbe8c4d1d969f, 0x7d1de38ecca79ea1, 0xa56f73ff2ab4aef5, 0x5ed1be4664e023fc}},
    {"soft and skinned, auto", {0x2167393320c256c0, 0x73785f893fc58b4a, 0xfe88867b487f85f0, 0x599e0262f33a0e94}},
    {"touched cut, auto", {0xff890838b753aeda, 0x78301d38166a0c4d, 0x29e81dc3d3f77047, 0xebd688f0a064404d}},
    {"touched cut, sdirk2", {0xfff94fb4d8b04cb2, 0x7703fb4052940586, 0x9012ea3de1692826, 0x90f8c6f5d5fb0608}},
    {"soft and touched cut, auto", {0xd5f884a9e30aa820, 0xafa633d77a236732, 0xd5ca7a71f85027a6, 0x645c53ed82d68dc2}},
    {"touched slice, auto", {0xc651e673aaed1229, 0x2a3c2e166b38947c, 0x51b304d05ff20876, 0x7260944cf4ed5a67}},
    {"touched slice, sdirk2", {0x7f2b67ca4ea3f792, 0x86c205262c51386a, 0x447dc71fb479b54d, 0xce1855b2801aecf8}},
    {"soft and touched slice, auto", {0x0aebf3b27fba0d04, 0x28707119c6812995, 0x52686a24bff63cc8, 0x10aa29c91f185a0f}},
    {"touched tear, auto", {0xc651e673aaed1229, 0x2679cc6654cc26d9, 0xeb6efd34f661fe4c, 0xdf26a7625e2e0229}},
    {"touched tear, sdirk2", {0x7f2b67ca4ea3f792, 0xa912a4c9e7e7fbf3, 0x9faa708316f21c01, 0x509bd87d7fbfed02}},
    {"touched bridge, auto", {0xc651e673aaed1229, 0x348aba0d485e58c2, 0x7a4ab7e11cb71495, 0x955e27c215c1a3c7}},
    {"touched bridge, sdirk2", {0x7f2b67ca4ea3f792, 0x47c6cc37ed67f2fe, 0x714ee4e96e5f6bc4, 0x78c4cfee8ab5aaee}},
    {"touched plane, auto", {0x05c70d5366a0e86f, 0x811278d67fdedd81, 0x3879200a256b26f5, 0xaaa9d897f4a0d320}},
    {"touched plane, sdirk2", {0x943a47562b9eb657, 0x4a415563d06b8cf7, 0xc35ccfdde2e20a57, 0xf78121f4fa222fcd}},
    {"touched edge, auto", {0x61cbf0e6f2fb833a, 0xbfae9e61761177f6, 0xa4cd0700f625bbb6, 0x80e3638ae709905c}},
    {"touched edge, sdirk2", {0x4e25e343a3f4899d, 0xbf3af1d31629873b, 0x1fb4497996d73104, 0xb6a0fd4aa9cb99ef}},
    {"two hands, auto", {0xc6c1d85d1512e690, 0x6d0f09b25ab908fc, 0x19f859d1a0c277d8, 0xe5fb21f6d7ae9b77}},
    {"two hands, sdirk2", {0x2dd376e2afb8ca46, 0x4b8af5b88a0ea494, 0xdc0d42591de018d5, 0x9426a95d4a6889ea}},
    {"soft and two hands, auto", {0x1180d4b4680c1d33, 0x782c33232b01b77d, 0x71c364b076b3e6ee, 0xd6215639b50b0831}},
    {"fine mesh, auto", {0x00c4c498b1ca5a4c, 0x61b0fff1042a87b0, 0x70ee73baaa9e928d, 0xb521f5e2d8d4ddb2}},
    {"fine mesh, sdirk2", {0xfbc106aac38946d1, 0x970261862069dfd3, 0x416142254c0f4879, 0xc1e7799b03e2deae}},
};

inline constexpr GoldenRow kGoldenRevision22[] = {
    {"wedge, sdirk2", {0x6ea36172c291d416, 0x28c7a22f71fa0d6e, 0x86be6848636bf6e0, 0x66dc76c9ebb3b1e1}},
    {"crumbs, sdirk2", {0x99b04d0562fdfad0, 0x8d4ee668492e3f6d, 0xa8761dc2125f48e6, 0xcf382d4d83d89c8e}},
    {"light, backward-euler", {0xd3d3d238bbc81e70, 0xd3b269e181b3410a, 0x1bafd5a461230ef4, 0x4a28133bd875b6a9}},
    {"light, sdirk2", {0x3e3014ff5c07bebd, 0x61d4a96c854a89ea, 0xc457b8cd0cfb9178, 0xf0638a105ec3bc21}},
    {"wedge, auto", {0xb6c71a93224b3c05, 0x532dc5c79cc197c6, 0x4c5f77ec8a764b8d, 0x5207a4cf9966e10a}},
    {"crumbs, auto", {0x7dbfc1a5b048509e, 0x087432173b042b76, 0x806836eb3478b758, 0x6293285d0784acc4}},
};

inline constexpr GoldenRow kGoldenRevision23[] = {
    {"full, sdirk2", {0xf7d91909688e9386, 0xaa4e28f19df69c50, 0x3544e31d68164751, 0xc5d924e20921046b}},
    {"wedge, sdirk2", {0xf7d91909688e9386, 0xaa4e28f19df69c50, 0xa0b8269a4d1fdbef, 0x5c735f71b3057342}},
    {"crumbs, sdirk2", {0x49a064c72a46500b, 0xebc4a9cb043f2988, 0xcaec63e09f30f20d, 0x79594ba391a9d57e}},
    {"light, backward-euler", {0xfce938316e2cdcc4, 0x943b3e3748b4a899, 0xeb6ce4f29619df07, 0x7fb7782ae1ed5bc9}},
    {"light, sdirk2", {0xf799bf7421823dc2, 0xbbb0ed88cd9ae829, 0x8ed5a885e5fc2033, 0x22a473d73dcb1785}},
    {"resisting, sdirk2", {0x9a33fe579fb87174, 0x7fac2474c2b7bdb2, 0x24123b01fde3f665, 0x25626c91995b8daf}},
    {"long strip, sdirk2", {0x8c6d2a8332d9ea84, 0xcc0315ee2ddde686, 0x8b4640d5c2e6e437, 0x3fa292cce69103d1}},
    {"skinned, sdirk2", {0x2477eaf59f2bf750, 0x59dc62e3e109d86b, 0x6f7362481cb3a001, 0xc597cfa067391896}},
    {"touched cut, sdirk2", {0x29b0ef585f323fe0, 0x7c4a4e8428564ca2, 0x7c986c11dd82ce9d, 0x9dce2d319d813653}},
    {"touched slice, sdirk2", {0x79ea9d3cd40c08a7, 0x45440f898e6c4063, 0x00d5226845088f35, 0xc04cfd31ad5474cc}},
    {"touched tear, sdirk2", {0x79ea9d3cd40c08a7, 0xf4bd25c7cd78fd51, 0x93be91cf387591a7, 0xe8ef917f2c8c2284}},
    {"touched bridge, sdirk2", {0x79ea9d3cd40c08a7, 0xdd0286f055bb2c0d, 0xfbdc129cd3533c92, 0xb5c34e13894b6bb8}},
    {"touched plane, sdirk2", {0x718da65f08192477, 0xb16636627161efa7, 0x3bb92d815d192f91, 0x03f1a9cfcb89a4af}},
    {"touched edge, sdirk2", {0x7f534bf22eafdbac, 0xaf956ac886c359b1, 0xcc6cb43f336071b3, 0x552ed0b50e5413ad}},
    {"two hands, sdirk2", {0x34d2cff83561a91f, 0x18d0b43595d01ea0, 0xac921d954c3bb9d8, 0x79374f3f0466d856}},
    {"fine mesh, sdirk2", {0x2a1d5e34c6a5e58a, 0x14f5ef1a8a3eae28, 0xe6653c36ca10c961, 0x2ae7e6d7aa194b1d}},
    {"ctpm, auto", {0x723942efcdab73a9, 0x72e2b126c9483c8f, 0x01b72b4ebda476d9, 0xeaf02b4f38295c34}},
    {"tpm, backward-euler", {0xedc2a23ffed183a2, 0xbda28cba822078c5, 0x268caa7c7f2d5865, 0x3bd59958129d00c5}},
    {"angle-mass-spring, backward-euler",
     {0x2ab987bbdd812e6f, 0xef69fc1da119ac16, 0x4c0538a89f1cb3f1, 0x74780638569a5baf}},
    {"ctpm, sdirk2", {0x9a33fe579fb87174, 0x55199fa56a43b3d5, 0x09e348e1063b55ed, 0xe671313a60d9b212}},
    {"full, auto", {0xd7f3150081fc0805, 0xafcd17cc8ec6534e, 0x27d4b4a23811249f, 0xc2f8300f69b262c8}},
    {"wedge, auto", {0xd7f3150081fc0805, 0xafcd17cc8ec6534e, 0x9145fd1e54f436d7, 0xec5f033789bc331d}},
    {"crumbs, auto", {0x729a47d3a073a817, 0x8782c9180e32e3f1, 0xd8e9c438d88bb438, 0xf11472ed7d6dcf16}},
    {"resisting, auto", {0x723942efcdab73a9, 0x88548f92197ca9f5, 0x9c5b554cadeacf36, 0xb00e7eeccdbd16fa}},
};

inline constexpr GoldenRevision kGoldenRevisions[] = {
    {1, kGoldenRevision1, 0x002bb904fcccbc09},   {2, kGoldenRevision2, 0xbcef5c03c7baaf6a},
    {3, kGoldenRevision3, 0xe38c0b55dc5ae189},   {4, kGoldenRevision4, 0x4963e0ca8fb6cfff},
    {5, kGoldenRevision5, 0xde01e1a50a84c47a},   {6, kGoldenRevision6, 0xa6eef089d8c4a783},
    {7, kGoldenRevision7, 0xe9b636c6028e3176},   {8, kGoldenRevision8, 0x7b7d2031be004e94},
    {9, kGoldenRevision9, 0xb75cb37d4faeb3c5},   {10, kGoldenRevision10, 0x6d5ddd69b485de71},
    {11, kGoldenRevision11, 0x4162fa4fa1d24cae}, {12, kGoldenRevision12, 0x1a990242ddda6fc4},
    {13, kGoldenRevision13, 0xa5637b24229bb1f2}, {14, kGoldenRevision14, 0x463cb460f23844de},
    {15, kGoldenRevision15, 0xc7644e74b0d461e5}, {16, kGoldenRevision16, 0x304838863b606220},
    {17, kGoldenRevision17, 0x47d495b0831911b},  {18, kGoldenRevision18, 0x519dbe9952522cb},
    {19, kGoldenRevision19, 0xbcff56bc1d9b0f37}, {20, kGoldenRevision20, 0xc16065d9ee0c4396},
    {21, kGoldenRevision21, 0x369412ffb9ec0589}, {22, kGoldenRevision22, 0x3fb5c7dfb63a9f52},
    {23, kGoldenRevision23, 0xeacc89825c5ea8f0},
};

/// Digest of a revision's rows (64-bit FNV-1a over names and hashes), chained to that of the revision before, or to 0.
constexpr std::uint64_t golden_digest(std::uint64_t before, std::span<const GoldenRow> rows) {
  std::uint64_t digest = before ^ 0xcbf29ce484222325;
  const auto add = [&](std::uint8_t byte) { digest = (digest ^ byte) * 0x100000001b3; };
  for (const GoldenRow& row : rows) {
    for (const char letter : row.session) add(std::uint8_t(letter));
    for (const std::uint64_t hash : row.hash)
      for (int byte = 0; byte < 8; ++byte) add(std::uint8_t(hash >> (8 * byte)));
  }
  return digest;
}

}  // namespace ctpm::testing
