# 手引き：八枚のカードの文と、図の中のことば（src/play/menus/manual/）。

card-1-title = 影はブラックホールより大きい
card-1-text = ブラックホールの「ふち」、事象の地平面の半径は r_s です。しかし光は、ふちに向かわなくてもつかまります。中心から 2.6 r_s より近くを通るはずの光は、曲がって落ちこみ、あなたには届きません。だから遠くからは、黒い影がブラックホールの 2.6 倍に見えます。
card-1-label-light = 光
card-1-label-hole = ブラックホール
card-1-label-shadow = 影の大きさ
card-1-label-caught = つかまる光
card-1-label-bent = 曲がる光

card-2-title = 円盤の向こう側が上に見える
card-2-text = 降着円盤は、お皿のように平らです。それなのに、向こう側がブラックホールの上にアーチのように見えます。上へ出た光が、曲がって届くからです。裏側から出た光は下を回り、影の下に細い弧になって見えます。ガスがそこにあるのではなく、光がそこから来るのです。
card-2-label-far = 向こう側
card-2-label-near = 手前
card-2-label-you = あなた
card-2-label-top = 表側
card-2-label-underside = 裏側
card-2-label-view = 見えるようす

card-3-title = 片側は青く明るく、反対側は赤く暗い
card-3-text = ガスは、最も速いところで光の半分の速さで回ります。近づく側の光は、波がつまって青くなり、前へ集まって明るくなります。遠ざかる側の光は、赤く暗くなります。これがドップラー効果です。さらに重力が、全体の光を少し赤くします。
card-3-label-away = 遠ざかる
card-3-label-towards = 近づく
card-3-label-you = あなたへ
card-3-label-red = 波がのびる：赤く暗い
card-3-label-blue = 波がつまる：青く明るい

card-4-title = 二つの像と、輪
card-4-text = 一せきの船の光が、ブラックホールの両側を通って届くことがあります。すると船は二つ見えます。第2の像は、光が遠回りをした分だけ古く、たいてい暗い像です。船が真後ろに来ると、光はまわり全部から届き、輪に見えます。アインシュタインリングです。
card-4-label-ship = 船
card-4-label-you = あなた
card-4-label-first = 第1の像
card-4-label-second = 第2の像
card-4-label-view = 見えるようす
card-4-label-ring = アインシュタインリング

card-5-title = 見えるのは過去
card-5-text = 光が届くには時間がかかります。光が着いたとき、船はもう先へ進んでいます。「見かけ」の印は、前にいた場所の、前の姿です。「現在」の輪は、時刻 T の今、船がいる場所です。そこから出た光は、まだ届いていません。「現在」へ向かって飛びましょう。
card-5-label-you = あなた
card-5-label-seen = 見かけ
card-5-label-now = 現在
card-5-label-light = 船の光

card-6-title = 自分の時計と遠くの時計
card-6-text = ブラックホールの近くでは、時計がゆっくり進みます。r = 2 r_s にとどまると、遠くの 100 秒の間に 71 秒しか進みません。速く動く時計も、ゆっくり進みます。だから、あなたは遠くの人より若いまま帰ります。自分では、何も変わったと感じません。
card-6-label-stays = とどまる
card-6-label-orbits = 軌道を回る
card-6-label-far = 遠く
card-6-label-rate = 時計の進み

card-7-title = 飛ぶことは、落ちること
card-7-text = 軌道とは、ブラックホールに当たらずに落ち続けることです。低い軌道は速く、高い軌道はゆっくりです。下りるには、減速するか、ブラックホールへ向けて噴射します。3 r_s より下の円は不安定で、少しのずれで落ちるか飛び出します。1.5 r_s では、光だけが円をえがけます。
card-7-label-high = 高い軌道：おそい
card-7-label-low = 低い軌道：速い
card-7-label-brake = 減速
card-7-label-stable = 3 r_s：最後の安定な円軌道
card-7-label-light = 1.5 r_s：光の円

card-8-title = 事象の地平面
card-8-text = r = r_s に壁はなく、これほど大きなブラックホールでは、特別なことは何も感じません。しかし外向きの光もそこから出られず、内側では光さえ落ちます。だから、こえたら戻れません。星の光はいっしょに落ちてくるので、星は見えます。前の影は、最後に空の半分になります。
card-8-label-time = 時間
card-8-label-singularity = 特異点
card-8-label-horizon = 事象の地平面
card-8-label-ship = 船
card-8-label-light = 外向きの光
card-8-label-view = 地平面で前を見ると
card-8-label-shadow = 影
